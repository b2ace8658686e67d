#include "geometry/elementary.hpp"

#include <echinus/geometry.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace echinus {

namespace {

/// The point at pi / 4 * part / count, by the Taylor series of cosine and sine: the first omitted term is
/// below 1e-19.
CirclePoint first_octant_point(std::uint64_t part, std::uint64_t count) {
    // Symmetry demands equal coordinates here; the two series may differ in the last digit.
    if (part == count) return {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2};
    const double angle_rad = static_cast<double>(part) / static_cast<double>(count) * (std::numbers::pi / 4);
    const double square = angle_rad * angle_rad;
    double cosine = 1;
    double sine = 1;
    for (int k = 18; k >= 2; k -= 2) {
        cosine = 1 - cosine * square / ((k - 1) * k);
        sine = 1 - sine * square / (k * (k + 1));
    }
    return {cosine, sine * angle_rad};
}

} // namespace

CirclePoint circle_point(std::uint64_t index, std::uint64_t count) {
    // The octant is computed in integers, so that the series are evaluated at the same angle for symmetric
    // indices.
    const std::uint64_t eighths = 8 * (index % count);
    const std::uint64_t octant = eighths / count;
    const std::uint64_t remainder = eighths % count;
    const bool mirrored = octant % 2 == 1;
    CirclePoint p = first_octant_point(mirrored ? count - remainder : remainder, count);
    if (mirrored) std::swap(p.cosine, p.sine);
    switch (octant / 2) { // number of quarter turns; 0 - x instead of -x avoids negative zeros
    case 0:
        return p;
    case 1:
        return {0 - p.sine, p.cosine};
    case 2:
        return {0 - p.cosine, 0 - p.sine};
    default:
        return {p.sine, 0 - p.cosine};
    }
}

Rotation Rotation::about(const Vec3d& axis, double angle_rad) {
    // Half the angle, rounded to steps of a full turn / 2^50, 6e-15 rad, so that every machine gives the same
    // bits.
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
    // The opposite quaternion is the same rotation; this one of the two rotates by at most half a turn.
    const double sign = w < 0 ? -1 : 1;
    const Vec3d axis{sign * x, sign * y, sign * z};
    const double sine = length(axis);
    if (!(sine > 0)) return {};
    return axis * (2 * portable_atan2(sine, sign * w) / sine);
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
