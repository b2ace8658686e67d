#include "simulation/contact/carry_field.hpp"

#include "collider/frame_change.hpp"
#include "simulation/contact/thresholds.hpp"
#include "simulation/surfaces/model_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

bool same_pose(const RigidTransform& a, const RigidTransform& b) {
    return a.translation == b.translation && a.rotation.w == b.rotation.w && a.rotation.x == b.rotation.x &&
           a.rotation.y == b.rotation.y && a.rotation.z == b.rotation.z;
}

constexpr std::size_t kPointsPerPiece = 256;

/// The bounding box of points.
struct BoxOfPoints {
    Vec3d low, high;

    BoxOfPoints(const PointArrays& points, std::size_t count) : low(points[0]), high(low) {
        for (std::size_t i = 1; i < count; ++i) {
            const Vec3d p(points[i]);
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
    }
    double distance(const Vec3d& p) const {
        return length(Vec3d{std::max({low.x - p.x, p.x - high.x, 0.0}),
                            std::max({low.y - p.y, p.y - high.y, 0.0}),
                            std::max({low.z - p.z, p.z - high.z, 0.0})});
    }
};

Vec3f displacement_at(const SurfaceMotion& motion, const Triangle& face, const Vec3f& point) {
    const auto shares =
        shares_in(std::array{motion.from[face[0]], motion.from[face[1]], motion.from[face[2]]}, point);
    Vec3f sum;
    for (std::size_t k = 0; k < 3; ++k) sum += (motion.to[face[k]] - motion.from[face[k]]) * shares[k];
    return sum;
}

/// The unit vector from the nearest point of a surface to a particle.
Vec3d direction_from(const Contact& contact, const Vec3f& particle) {
    const Vec3d between = Vec3d(particle) - Vec3d(contact.point);
    const double distance = length(between);
    return distance > 0 ? between * (1 / distance) : Vec3d(contact.normal);
}

/// The part of a displacement that carries a particle: all of the component that would close the gap, and as
/// much of the rest as the particle moves by itself. So a surface that only passes drags nothing along.
/// @param away  the direction from the surface to the particle
/// @param own   the displacement that the particle has without the collider
Vec3d taken(const Vec3d& displacement, const Vec3d& away, const Vec3d& own) {
    const Vec3d closing = away * std::max(dot(away, displacement), 0.0);
    const Vec3d rest = displacement - closing;
    const double rest_sq = dot(rest, rest);
    return rest_sq > 0 ? closing + rest * std::clamp(dot(own, rest) / rest_sq, 0.0, 1.0) : closing;
}

} // namespace

Deformation::Deformation(const Collider& before, const DeformingCollider& surface, const PointArrays& points,
                         std::size_t point_count, double room, double touch, const Workers& workers)
    : motion(surface.motion()) {
    if (motion == nullptr || point_count == 0) return;
    const FrameChange body(before.pose, {1, 1, 1});
    const BoxOfPoints box(points, point_count);
    for (std::size_t v = 0; v < surface.vertices().size(); ++v) {
        const double displacement{length(motion->to[v] - motion->from[v])};
        if (displacement > longest &&
            box.distance(body.point_to_world<double>(motion->from[v])) <= displacement + touch + room)
            longest = displacement;
    }
    ScratchVector<Vec3f> places(point_count, workers.scratch());
    points.store(places);
    ScratchVector<Contact> contacts(point_count, workers.scratch());
    const auto reach = static_cast<float>(touch + threshold::kFade * longest);
    workers.for_ranges(point_count, kPointsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           contacts_batch(before, std::span(places).subspan(begin, end - begin), reach,
                                          std::span(contacts).subspan(begin, end - begin));
                       });
    for (std::uint32_t i = 0; i < point_count; ++i) {
        if (!contacts[i].found() || contacts[i].face == kNoIndex) continue;
        const Triangle& face = surface.faces()[contacts[i].face];
        near.push_back({i, std::fabs(contacts[i].depth),
                        displacement_at(*motion, face, body.point_to_local(contacts[i].point)),
                        direction_from(contacts[i], places[i])});
    }
}

double CarryField::longest_displacement(const Collider& before, const Collider& after) {
    if (same_pose(before.pose, after.pose)) return 0;
    const ExactMap* const map = map_of_surface(before);
    if (map == nullptr) return 0;
    const ExactMapView view = map->view();
    const Vec3d scale = before.scale;
    const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
    const Vec3d centre = times(Vec3d(view.centre), scale);
    const Rotation turn = after.pose.rotation * before.pose.rotation.inverse();
    const double sine = length(Vec3d{turn.x, turn.y, turn.z});
    return length(after.pose.to_world(centre) - before.pose.to_world(centre)) +
           2 * sine * largest * double{view.radius};
}

bool CarryField::may_carry(const Collider& before, const Collider& after, const PointArrays& points,
                           std::size_t point_count, double room, double touch) {
    const double longest = longest_displacement(before, after);
    if (longest == 0) return false;
    const ExactMapView view = map_of_surface(before)->view();
    const Vec3d scale = before.scale;
    const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
    return BoxOfPoints(points, point_count)
               .distance(before.pose.to_world(times(Vec3d(view.centre), scale))) <=
           largest * double{view.radius} + longest * (1 + threshold::kFade) + touch + room;
}

CarryField::CarryField(const std::vector<Collider>& before, const std::vector<Collider>& after,
                       std::span<const std::uint8_t> is_near, std::span<const Deformation> deformations,
                       const FramePart& part, double touch)
    : before_(before), after_(after), is_near_(is_near), deformations_(deformations), part_(part),
      touch_(touch), reach_(touch) {
    for (std::size_t c = 0; c < before.size(); ++c) {
        if (is_near[c] == 0 && deformations[c].motion == nullptr) continue;
        const double longest = longest_displacement(before[c], after[c]) +
                               deformations[c].longest * double{part.end - part.begin};
        moves_ = moves_ || longest > 0 || deformations[c].motion != nullptr;
        reach_ = std::max(reach_, touch + threshold::kFade * longest);
    }
}

struct CarryField::Blend {
    Vec3d sum;
    double weights = 0, nearest = std::numeric_limits<double>::infinity();

    void add(const Vec3d& displacement, float distance) {
        const double away = std::max(double{distance}, std::numeric_limits<double>::min());
        nearest = std::min(nearest, away);
        sum += displacement * (1 / away);
        weights += 1 / away;
    }
};

void CarryField::add_rigid(std::size_t collider, const Vec3f& point, const Vec3d& own, Blend& blend) const {
    if (map_of_surface(before_[collider]) == nullptr) return;
    const Contact found = contact(before_[collider], point, static_cast<float>(reach_));
    if (!found.found()) return;
    const RigidTransform &before = before_[collider].pose, &after = after_[collider].pose;
    const Vec3d displacement = after.to_world(before.to_local(Vec3d(point))) - Vec3d(point);
    blend.add(taken(displacement, direction_from(found, point), own), std::fabs(found.depth));
}

void CarryField::add_deforming(std::size_t collider, const PointArrays& points, Places own,
                               std::span<Blend> blends) const {
    const RigidTransform &before = before_[collider].pose, &after = after_[collider].pose;
    const double share{part_.end - part_.begin};
    for (const Deformation::Near& near : deformations_[collider].near) {
        const Vec3d point(points[near.particle]);
        const Vec3d to = before.to_local(point) + Vec3d(near.displacement) * share;
        blends[near.particle].add(taken(after.to_world(to) - point, near.away, own[near.particle]),
                                  near.distance);
    }
}

Vec3d CarryField::displacement_of(const Blend& blend) const {
    if (!(blend.nearest < reach_)) return {};
    const double fading = blend.nearest <= touch_ ? 1 : (reach_ - blend.nearest) / (reach_ - touch_);
    return blend.sum * (fading / blend.weights);
}

void CarryField::carry(PointArrays& points, std::span<const std::uint8_t> is_held, Places own,
                       const Workers& workers) const {
    if (!moves_) return;
    ScratchVector<Blend> blends(is_held.size(), workers.scratch());
    for (std::size_t c = 0; c < before_.size(); ++c)
        if (deformations_[c].motion != nullptr) add_deforming(c, points, own, blends);
    const auto carry_point = [&](std::size_t i) {
        if (is_held[i] != 0) return;
        for (std::size_t c = 0; c < before_.size(); ++c)
            if (is_near_[c] != 0 && deformations_[c].motion == nullptr)
                add_rigid(c, points[i], own[i], blends[i]);
        points.set(i, Vec3f(Vec3d(points[i]) + displacement_of(blends[i])));
    };
    workers.for_ranges(is_held.size(), kPointsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t i = begin; i < end; ++i) carry_point(i);
                       });
}

} // namespace echinus
