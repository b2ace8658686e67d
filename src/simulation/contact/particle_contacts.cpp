#include "simulation/contact/particle_contacts.hpp"

#include "simulation/contact/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace echinus {

ParticleContacts::ParticleContacts(const Deformable& deformable, const std::vector<Collider>& colliders,
                                   std::span<const std::uint8_t> collides, double thickness, double friction)
    : thickness_(thickness), friction_(friction) {
    for (std::uint32_t c = 0; c < colliders.size(); ++c)
        if (collides[c] != 0) obstacles_.push_back({c, let_through(deformable, c)});
}

void ParticleContacts::begin_step(const std::vector<Collider>& before, const std::vector<Collider>& after,
                                  Places start, std::span<const std::uint8_t> is_held) {
    if (empty()) return;
    before_.clear();
    after_.clear();
    for (const Obstacle& obstacle : obstacles_) {
        before_.push_back(before[obstacle.number]);
        after_.push_back(after[obstacle.number]);
    }
    start_.assign(start.begin(), start.end());
    is_held_ = is_held;
    find(start, 0);
    began_inside_.clear();
    put_.clear();
    for (const Found& found : found_)
        if (found.inside) began_inside_.push_back({found.particle, found.obstacle});
}

void ParticleContacts::move(std::uint32_t collider, const RigidTransform& pose) {
    for (std::size_t o = 0; o < obstacles_.size(); ++o)
        if (obstacles_[o].number == collider) after_[o].pose = pose;
}

void ParticleContacts::Answers::resize(std::size_t count) {
    particles.resize(count);
    colliders.resize(count);
    points.resize(count);
    normals.resize(count);
    depths.resize(count);
    inside.resize(count);
}

/// Finds all particles that are inside, or outside within a margin.
void ParticleContacts::find(Places places, double margin) {
    const auto ask = [&](const ContactArrays<double>& contacts) {
        return contacts_into(after_, StridedSpan<const Vec3d>(places), static_cast<float>(margin), contacts);
    };
    answers_.resize(std::max(places.size(), answers_.particles.size()));
    std::size_t count = 0;
    for (;;) {
        count = ask({.particles = answers_.particles,
                     .points = answers_.points,
                     .normals = answers_.normals,
                     .depths = answers_.depths,
                     .inside = answers_.inside,
                     .colliders = answers_.colliders});
        query_count_ += places.size() * after_.size();
        if (count <= answers_.particles.size()) break;
        answers_.resize(count);
    }
    const auto& [particles, colliders, points, normals, depths, inside] = answers_;
    found_.clear();
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint32_t i = particles[n];
        const std::vector<std::uint8_t>& passes = obstacles_[colliders[n]].passes;
        if (is_held_[i] != 0 || (!passes.empty() && passes[i] != 0)) continue;
        found_.push_back({i, colliders[n], points[n], Vec3d(normals[n]), double{depths[n]}, inside[n] != 0});
    }
}

/// Where the collider carries a particle from its position at the beginning of the step.
Vec3d ParticleContacts::carried(std::uint32_t particle, std::uint32_t obstacle) const {
    const RigidTransform &before = before_[obstacle].pose, &after = after_[obstacle].pose;
    const Vec3d start = start_[particle];
    const Vec3d material = before.to_local(start);
    return start + (after.to_world(material) - before.to_world(material));
}

/// Is a particle deeper than the distance it moved, although it began outside? Then it came through no
/// surface that the map knows: at a silhouette, neighbouring directions of a distance map differ in their
/// number of layers, and the way out along the ray may be far from the way in.
bool ParticleContacts::came_through_a_side(const Found& found, const Vec3d& place) const {
    const auto order = [](const Inside& a, const Inside& b) {
        return std::tie(a.obstacle, a.particle) < std::tie(b.obstacle, b.particle);
    };
    const double below = dot(found.normal, found.point - place);
    const double depth = below > 0 ? std::min(below, found.depth) : found.depth;
    return found.inside && depth > length(place - carried(found.particle, found.obstacle)) &&
           !std::binary_search(began_inside_.begin(), began_inside_.end(),
                               Inside{found.particle, found.obstacle}, order);
}

void ParticleContacts::add_to(ContactSet& contacts, Places places, std::span<const double> masses,
                              std::span<const double> strengths, std::span<const FreeBody> free_bodies,
                              bool is_solved) {
    if (empty()) return;
    find(places, threshold::kParticleReach * thickness_);
    for (const Found& found : found_) {
        const Vec3d place = places[found.particle];
        if (came_through_a_side(found, place)) continue;
        ContactSet::Contact contact;
        contact.normal = found.normal;
        // The particle is inside and yet in front of the plane: it leaves along the ray, as in the paper.
        if (found.inside && dot(found.normal, place - found.point) >= 0) contact.normal = found.point - place;
        const double size = length(contact.normal);
        if (!(size > 0)) continue;
        contact.normal *= 1 / size;
        const std::uint32_t i = found.particle;
        const std::uint32_t number = obstacles_[found.obstacle].number;
        const double gap = dot(contact.normal, place - found.point);
        if (!(gap < threshold::kReady * thickness_)) continue;
        contact.key = {number, PairKind::VertexFace, {i, i, i, i}};
        contact.particles.fill(i);
        contact.weights[0] = 1;
        contact.offset = -dot(contact.normal, found.point);
        contact.thickness = thickness_;
        contact.friction = friction_;
        contact.mobility = 1 / masses[i];
        contact.yielding = 1 / strengths[i];
        Vec3d start = carried(i, found.obstacle);
        for (const FreeBody& body : free_bodies) {
            if (body.collider() != number) continue;
            start = start_[i];
            body.join(contact, start, found.point);
        }
        contacts.add(contact, start, is_solved ? std::optional(gap) : std::nullopt);
    }
}

bool ParticleContacts::put_outside(std::span<Vec3d> places, std::span<std::uint8_t> is_put) {
    if (empty()) return false;
    for (int round = 0;; ++round) {
        find(places, 0);
        if (round == threshold::kMostRoundsOutside) {
            for (const Found& found : found_) lost_count_ += found.inside ? 1 : 0;
            break;
        }
        bool is_any_inside = false;
        for (const Found& found : found_) {
            if (!found.inside) continue;
            is_any_inside = true;
            Vec3d& place = places[found.particle];
            const bool goes_back = came_through_a_side(found, place);
            put_.push_back({{found.particle, found.obstacle}, place, goes_back});
            place =
                goes_back ? carried(found.particle, found.obstacle) : found.point + found.normal * thickness_;
            is_put[found.particle] = 1;
        }
        if (!is_any_inside) break;
    }
    return !put_.empty();
}

void ParticleContacts::end_step(const std::vector<Collider>& after, Places places,
                                std::span<Vec3d> velocities, double step) {
    for (std::size_t o = 0; o < obstacles_.size(); ++o) after_[o] = after[obstacles_[o].number];
    // Backwards, so that the first entry of a particle decides.
    for (auto put = put_.rbegin(); put != put_.rend(); ++put)
        velocities[put->particle] = (put->from - start_[put->particle]) * (1 / step);
    for (const Inside& inside : began_inside_) keep_with_surface(inside, places, velocities);
    for (const Put& put : put_) {
        if (put.goes_back)
            velocities[put.particle] = velocity_at(after_[put.obstacle], places[put.particle]);
        else
            keep_with_surface(put, places, velocities);
    }
}

/// Makes the component of a velocity across the collider's surface that of the surface.
void ParticleContacts::keep_with_surface(const Inside& inside, Places places,
                                         std::span<Vec3d> velocities) const {
    const Collider& collider = after_[inside.obstacle];
    const Vec3d place = places[inside.particle];
    const Contact found =
        contact(collider, Vec3f(place), static_cast<float>(threshold::kParticleReach * thickness_));
    if (!found.found()) return;
    const Vec3d normal(found.normal);
    Vec3d& velocity = velocities[inside.particle];
    velocity += normal * dot(normal, velocity_at(collider, place) - velocity);
}

} // namespace echinus
