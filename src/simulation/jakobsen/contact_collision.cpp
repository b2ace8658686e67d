#include "simulation/jakobsen/contact_collision.hpp"

#include <algorithm>
#include <span>
#include <variant>

namespace echinus {

namespace {

/// The size of the pieces of a query, and the margin of its contacts in thicknesses.
struct QueryPlan {
    std::size_t piece_size;
    float reach_in_thicknesses;
};

/// Pieces that fit into the first-level cache, and a reach along the rays that the thickness requires.
constexpr QueryPlan kDistanceMapPlan{256, kReachInThicknesses};
/// Larger pieces, since a custom map may have to set something up for each call.
constexpr QueryPlan kCustomMapPlan{4096, 1};

QueryPlan plan_for(const Collider& collider) {
    return std::holds_alternative<DistanceMap>(collider.map.kind) ? kDistanceMapPlan : kCustomMapPlan;
}

/// Is a particle deeper than the distance that it moved, although it began the frame outside? Then it came
/// through no surface that the map knows. With a distance map it came through the side of a layer: at a
/// silhouette neighbouring directions differ in their number of entries, and the way out along the ray may be
/// far from the way in.
bool came_through_a_side(const Collider& collider, const Contact& contact, const Vec3f& start,
                         const Vec3f& motion) {
    return contact.inside && contact.depth > length(motion) && !contains(collider, start);
}

/// The part of a particle's motion that a contact permits. A particle that came through a side returns to its
/// previous position.
/// @param motion  since the last frame, relative to the collider's material
Vec3f answer(const Collider& collider, const Contact& contact, const Vec3f& position, const Vec3f& motion,
             const ResponseRules& rules) {
    if (came_through_a_side(collider, contact, position - motion, motion)) return {};
    return respond(position, motion, contact, rules);
}

} // namespace

ContactCollision::ContactCollision(const Collider& collider, const Particles& particles,
                                   std::span<const std::uint8_t> passes, const SimulationOptions& options)
    : collider_(collider), rules_{static_cast<float>(options.thickness.value()),
                                  static_cast<float>(options.friction)},
      passes_(passes.begin(), passes.end()),
      reach_(plan_for(collider).reach_in_thicknesses * rules_.thickness),
      places_(std::min(plan_for(collider).piece_size, particles.count())), contacts_(places_.size()) {}

void ContactCollision::begin_frame(const Collider& collider, const RigidTransform& previous_pose) {
    collider_.pose = collider.pose;
    material_ = MaterialMotion(previous_pose, collider.pose);
}

void ContactCollision::relax(Particles& particles, SimulationProfile& profile, const Workers&) {
    for (std::size_t begin = 0; begin < particles.count(); begin += places_.size())
        profile.contact_count += relax_piece(begin, particles);
    profile.map_query_count += particles.count();
}

/// @return how many particles were pushed
std::size_t ContactCollision::relax_piece(std::size_t begin, Particles& particles) {
    const std::size_t count = std::min(places_.size(), particles.count() - begin);
    for (std::size_t k = 0; k < count; ++k) places_[k] = particles.positions[begin + k];
    contacts_batch(collider_, std::span<const Vec3f>(places_).first(count), reach_,
                   std::span(contacts_).first(count));
    std::size_t pushed_count = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = begin + k;
        if (!needs_response(places_[k], contacts_[k], rules_.thickness) || particles.pinned(i)) continue;
        if (!passes_.empty() && passes_[i] != 0) continue;
        const Vec3f material = material_.at(places_[k]);
        const Vec3f motion = particles.step(i) - material;
        particles.set_step(i, material + answer(collider_, contacts_[k], places_[k], motion, rules_));
        ++pushed_count;
    }
    return pushed_count;
}

/// The map is queried again, since the contacts of a piece are not kept.
Vec3d ContactCollision::without_approach(std::size_t i, const Particles& particles,
                                         const Vec3d& motion) const {
    if (!passes_.empty() && passes_[i] != 0) return motion;
    const Vec3f position = particles.positions[i];
    const Contact nearest = contact(collider_, position, kTouchInThicknesses * reach_);
    if (!needs_response(position, nearest, kTouchInThicknesses * rules_.thickness)) return motion;
    const Vec3d material(material_.at(position));
    return material + stopped_motion(motion - material, nearest.normal, rules_.friction);
}

} // namespace echinus
