#include "tetrahedra/body_lattice.hpp"

#include "geometry/whole_numbers.hpp"

#include <cmath>

namespace echinus {

namespace {

/// Cubes along an axis: a layer below the box, one above, and the corners that end the last.
double cube_count(double low, double high, double size) {
    return std::ceil((high - low) / size) + 3;
}

} // namespace

BodyLattice::BodyLattice(const Vec3d& low, const Vec3d& high, double size)
    : size_(size), counts_{truncated_to<std::uint64_t>(cube_count(low.x, high.x, size)),
                           truncated_to<std::uint64_t>(cube_count(low.y, high.y, size)),
                           truncated_to<std::uint64_t>(cube_count(low.z, high.z, size))} {
    // The box in the middle of the corners, of which each axis has as many as cubes.
    const auto half_extent = [&](std::uint64_t count) { return static_cast<double>(count - 1) * size / 2; };
    origin_ =
        (low + high) * 0.5 - Vec3d{half_extent(counts_[0]), half_extent(counts_[1]), half_extent(counts_[2])};
}

double BodyLattice::vertex_count_around(const Vec3d& low, const Vec3d& high, double size) {
    return 2 * cube_count(low.x, high.x, size) * cube_count(low.y, high.y, size) *
           cube_count(low.z, high.z, size);
}

} // namespace echinus
