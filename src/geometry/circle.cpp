#include "geometry/circle.hpp"

#include <numbers>
#include <utility>

namespace echinus {

namespace {

/// The point at pi / 4 * part / count by the Taylor series of cosine and sine: the first term left out is
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
    // The octant is found in integers, so that symmetric indices evaluate the series at the same angle.
    const std::uint64_t eighths = 8 * (index % count);
    const std::uint64_t octant = eighths / count;
    const std::uint64_t remainder = eighths % count;
    const bool mirrored = octant % 2 == 1;
    CirclePoint p = first_octant_point(mirrored ? count - remainder : remainder, count);
    if (mirrored) std::swap(p.cosine, p.sine);
    switch (octant / 2) { // quarter turns; 0 - x instead of -x avoids negative zeros
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

} // namespace echinus
