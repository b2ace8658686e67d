#include "simulation/contact/free_body.hpp"

#include "mechanics/small_matrix.hpp"
#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// The corners of a regular tetrahedron; the mean of their outer products is the identity.
constexpr std::array<Vec3d, FreeBody::kPointCount> kCorners{
    {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}};

/// The principal axes, as long as the standard deviations of the mass along them; right-handed.
Matrix3 spread_of(const RigidBody& body) {
    const Eigensystem moments = body.second_moments();
    Matrix3 spread = moments.vectors;
    if (determinant(spread) < 0) spread[2] = -spread[2];
    for (std::size_t k = 0; k < 3; ++k) spread[k] *= std::sqrt(moments.values[k]);
    return spread;
}

/// The rotation that takes unit axes closest to others, to which they nearly fit: found by turning about the
/// axis and by the angle that all three have in common (Mueller et al. 2016).
Rotation nearest_rotation(const Matrix3& axes, const Matrix3& turned, Rotation rotation) {
    for (int turn = 0; turn < threshold::kMostFittingTurns; ++turn) {
        Vec3d across;
        double along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d axis = rotation.apply(axes[k]);
            across += cross(axis, turned[k]);
            along += dot(axis, turned[k]);
        }
        const Vec3d vector = across * (1 / std::abs(along));
        const double angle = length(vector);
        if (!(angle > threshold::kFittingPrecision) || !std::isfinite(angle)) break;
        rotation = (Rotation::about(vector, angle) * rotation).normalised();
    }
    return rotation;
}

} // namespace

FreeBody::FreeBody(std::uint32_t collider, std::uint32_t first_point, const RigidBody& body)
    : collider_(collider), first_point_(first_point), point_mass_(body.mass() / kPointCount),
      centre_(body.centre()), spread_(spread_of(body)) {}

bool FreeBody::is_of(std::uint32_t collider, const RigidBody& body) const {
    return collider == collider_ && body.mass() == point_mass_ * kPointCount && body.centre() == centre_ &&
           spread_of(body) == spread_;
}

void FreeBody::add_to(ElasticParts& parts, double time_step) const {
    const std::array<Vec3d, kPointCount> points = points_at({});
    for (const Vec3d& point : points) {
        parts.rest_places.push_back(point);
        parts.masses.push_back(point_mass_);
    }
    const auto& [a, b, c, d] = points;
    const Vec3d at_b = cross(c - a, d - a), at_c = cross(d - a, b - a), at_d = cross(b - a, c - a);
    const double six_volumes = dot(b - a, at_b), share = 1 / six_volumes;
    double size_sq = 0;
    for (const Vec3d& column : spread_) size_sq += dot(column, column);
    const double inertia = kPointCount * point_mass_ / (time_step * time_step);
    const auto modulus =
        static_cast<float>(threshold::kBodyStiffness * inertia * size_sq / (six_volumes / 6));
    parts.tetrahedra.push_back(
        {.particles = {first_point_, first_point_ + 1, first_point_ + 2, first_point_ + 3},
         .gradients = {Vec3f(at_b * share), Vec3f(at_c * share), Vec3f(at_d * share)},
         .volume = static_cast<float>(six_volumes / 6),
         .mu = modulus,
         .lambda = modulus,
         .damping = 0});
}

std::array<Vec3d, FreeBody::kPointCount> FreeBody::points_at(const RigidTransform& pose) const {
    std::array<Vec3d, kPointCount> points;
    for (std::size_t k = 0; k < kPointCount; ++k)
        points[k] = pose.to_world(centre_ + times(spread_, kCorners[k]));
    return points;
}

void FreeBody::put(const RigidTransform& pose, std::span<Vec3d> places) const {
    const std::array<Vec3d, kPointCount> points = points_at(pose);
    std::copy(points.begin(), points.end(), places.begin() + first_point_);
}

RigidTransform FreeBody::fit(std::span<const Vec3d> places, const RigidTransform& near) const {
    const auto points = places.subspan(first_point_, kPointCount);
    const std::array<Vec3d, kPointCount> of_near = points_at(near);
    if (std::equal(points.begin(), points.end(), of_near.begin())) return near; // bitwise equal
    Vec3d middle;
    for (const Vec3d& point : points) middle += point * (1.0 / kPointCount);
    Matrix3 axes{}, turned{};
    for (std::size_t k = 0; k < kPointCount; ++k) {
        const Vec3d arm = (points[k] - middle) * (1.0 / kPointCount);
        turned[0] += arm * kCorners[k].x;
        turned[1] += arm * kCorners[k].y;
        turned[2] += arm * kCorners[k].z;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double deviation = length(spread_[k]);
        axes[k] = spread_[k] * (1 / deviation);
        turned[k] *= 1 / deviation;
    }
    const Rotation rotation = nearest_rotation(axes, turned, near.rotation);
    return {rotation, middle - rotation.apply(centre_)};
}

Load FreeBody::load(const RigidTransform& led, double seconds) const {
    const std::array<Vec3d, kPointCount> places = points_at(safe_pose), from = points_at(led);
    Load load;
    for (std::size_t k = 0; k < kPointCount; ++k) {
        const Vec3d force = (places[k] - from[k]) * (point_mass_ / (seconds * seconds));
        load.force += force;
        load.torque += cross(places[k] - safe_pose.translation, force);
    }
    return load;
}

void FreeBody::join(ContactSet::Contact& contact, Vec3d& start_apart, const Vec3d& point) const {
    const Vec3d arm = safe_pose.to_local(point) - centre_;
    const auto along = [&](const Vec3d& axis) { return dot(axis, arm) / dot(axis, axis); };
    const Vec3d from_centre{along(spread_[0]), along(spread_[1]), along(spread_[2])};
    const std::array<Vec3d, kPointCount> now = points_at(safe_pose), before = points_at(start_pose);
    for (std::size_t k = 0; k < kPointCount; ++k) {
        const double share = (1 + dot(kCorners[k], from_centre)) / kPointCount;
        contact.particles[4 + k] = first_point_ + static_cast<std::uint32_t>(k);
        contact.weights[4 + k] = -share;
        contact.offset += share * dot(contact.normal, now[k]);
        start_apart -= before[k] * share;
        contact.mobility += share * share / point_mass_;
    }
    contact.part_count = 4 + kPointCount;
}

} // namespace echinus
