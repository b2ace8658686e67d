#include "geometry/circle.hpp"

#include <echinus/geometry.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace echinus {

namespace {

/// The angle whose tangent is sine / (1 + cosine), half the one with this sine and cosine; three times
/// halved, so that a short series will do. @pre sine and cosine are not negative
double half_angle_of(double sine, double cosine) {
    double tangent = sine / (1 + cosine);
    for (int i = 0; i < 3; ++i) tangent = tangent / (1 + std::sqrt(1 + tangent * tangent));
    // Of tangents up to 0.1, atan to the last bit: x - x^3 / 3 + x^5 / 5 ...
    const double square = tangent * tangent;
    double sum = 0;
    for (int power = 17; power > 0; power -= 2) sum = 1.0 / power - square * sum;
    return 8 * tangent * sum;
}

} // namespace

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

Vec3d Rotation::vector() const {
    // The opposite quaternion turns the same way; of the two, this one turns by half a turn or less.
    const double sign = w < 0 ? -1 : 1;
    const Vec3d axis{sign * x, sign * y, sign * z};
    const double sine = length(axis);
    if (!(sine > 0)) return {};
    return axis * (4 * half_angle_of(sine, sign * w) / sine);
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
