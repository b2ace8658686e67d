#include "geometry/circle.hpp"

#include <echinus/geometry.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace echinus {

Rotation Rotation::about(const Vec3d& axis, double angle_rad) {
    // Half the angle in steps of a full turn / 2^50, 6e-15 rad, so that every machine gives the same bits.
    constexpr std::int64_t kStepsPerTurn = std::int64_t{1} << 50;
    const double half_turns = std::remainder(angle_rad, 4 * std::numbers::pi) / (4 * std::numbers::pi);
    const std::int64_t steps = std::llround(half_turns * static_cast<double>(kStepsPerTurn));
    const CirclePoint half = circle_point(static_cast<std::uint64_t>(steps + kStepsPerTurn),
                                          static_cast<std::uint64_t>(kStepsPerTurn));
    const double s = half.sine / length(axis);
    return Rotation{half.cosine, s * axis.x, s * axis.y, s * axis.z}.normalised();
}

Vec3d Rotation::apply(const Vec3d& v) const {
    // v + 2 u x (u x v + w v), the expansion of q v q* for a unit quaternion.
    const Vec3d u{x, y, z};
    const Vec3d t = cross(u, v) + v * w;
    return v + cross(u, t) * 2.0;
}

Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Rotation Rotation::normalised() const {
    const double s = 1 / std::sqrt(w * w + x * x + y * y + z * z);
    return {w * s, x * s, y * s, z * s};
}

} // namespace echinus
