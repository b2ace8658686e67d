#include "simulation/contact/free_body.hpp"

#include "mechanics/thresholds.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// The corners of a regular tetrahedron: the mean of their outer products is the identity.
constexpr std::array<Vec3d, FreeBody::kPointCount> kCorners{
    {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}};

/// The lower triangular L with L L^T = m. @pre m is positive definite
Matrix3 lower_root(const Matrix3& m) {
    Matrix3 root{};
    root[0].x = std::sqrt(m[0].x);
    root[0].y = m[0].y / root[0].x;
    root[0].z = m[0].z / root[0].x;
    root[1].y = std::sqrt(m[1].y - root[0].y * root[0].y);
    root[1].z = (m[1].z - root[0].z * root[0].y) / root[1].y;
    root[2].z = std::sqrt(m[2].z - root[0].z * root[0].z - root[1].z * root[1].z);
    return root;
}

/// The x with L x = v.
Vec3d solve_lower(const Matrix3& lower, const Vec3d& v) {
    const double x = v.x / lower[0].x;
    const double y = (v.y - lower[0].y * x) / lower[1].y;
    return {x, y, (v.z - lower[0].z * x - lower[1].z * y) / lower[2].z};
}

/// The rotation next to a matrix that nearly is one: turns by what the columns of both have in common
/// (Mueller et al. 2016).
Rotation nearest_rotation(const Matrix3& matrix, Rotation rotation) {
    constexpr int kMostTurns = 64; // converges quadratically next to a rotation
    constexpr double kNegligible = 1e-15;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const Matrix3 axes{rotation.apply({1, 0, 0}), rotation.apply({0, 1, 0}), rotation.apply({0, 0, 1})};
        Vec3d across;
        double along = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            across += cross(axes[k], matrix[k]);
            along += dot(axes[k], matrix[k]);
        }
        const Vec3d vector = across * (1 / std::abs(along));
        const double angle = length(vector);
        if (!(angle > kNegligible) || !std::isfinite(angle)) break;
        rotation = (Rotation::about(vector, angle) * rotation).normalised();
    }
    return rotation;
}

} // namespace

FreeBody::FreeBody(std::uint32_t collider, std::uint32_t first_point, const RigidBody& body)
    : collider_(collider), first_point_(first_point), point_mass_(body.mass() / kPointCount),
      centre_(body.centre()), spread_(lower_root(body.second_moments())) {}

bool FreeBody::is_of(std::uint32_t collider, const RigidBody& body) const {
    return collider == collider_ && body.mass() == point_mass_ * kPointCount && body.centre() == centre_ &&
           lower_root(body.second_moments()) == spread_;
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
    if (std::equal(points.begin(), points.end(), of_near.begin())) return near; // to the bit
    Vec3d middle;
    for (const Vec3d& point : points) middle += point * (1.0 / kPointCount);
    // Of the affine map, times the root of the second moments.
    Matrix3 spread{};
    for (std::size_t k = 0; k < kPointCount; ++k) {
        const Vec3d arm = (points[k] - middle) * (1.0 / kPointCount);
        spread[0] += arm * kCorners[k].x;
        spread[1] += arm * kCorners[k].y;
        spread[2] += arm * kCorners[k].z;
    }
    Matrix3 map;
    map[2] = spread[2] * (1 / spread_[2].z);
    map[1] = (spread[1] - map[2] * spread_[1].z) * (1 / spread_[1].y);
    map[0] = (spread[0] - map[1] * spread_[0].y - map[2] * spread_[0].z) * (1 / spread_[0].x);
    const Rotation rotation = nearest_rotation(map, near.rotation);
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
    const Vec3d from_centre = solve_lower(spread_, safe_pose.to_local(point) - centre_);
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
