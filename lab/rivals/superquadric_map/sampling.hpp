#pragma once

#include "directions/lattice.hpp"
#include "directions/spherical_grid.hpp"
#include "geometry/elementary.hpp"
#include "rivals/superquadric_map/superquadric.hpp"

#include <vector>

namespace echinus::rivals {

/// A point of a superellipse with half axes 1: the cosine and sine of an angle to the power of an exponent.
struct ProfilePoint {
    double cosine, sine;
};
/// The angle eta of a row of samples. Rows run down from the pole of +z.
inline CirclePoint eta_of_row(std::uint32_t row, std::uint32_t row_count) {
    const CirclePoint from_pole = circle_point(2 * std::uint64_t{row} + 1, 4 * std::uint64_t{row_count});
    return {from_pole.sine, from_pole.cosine};
}
ProfilePoint profile_point(const CirclePoint& angle, double exponent);

/// The samples of a superquadric's grid as points of its surface, in its frame, by index in the grid.
std::vector<Vec3d> sample_points(const Superquadric& shape, const SphericalGrid& grid);

/// How far from the centre each ray crosses a face of the segment for the last time or, where it crosses
/// none, a face of its hull, in the mesh's unit; negative where it misses both. The rays run from the
/// lattice's origin through the sample points; which faces they meet is decided exactly.
/// @param lattice         the segment, around the superquadric's centre
/// @param own_face_count  so many faces are the segment's, the others the hull's
/// @param shape           gives the samples' frame
std::vector<float> outermost_crossings(const LatticeMesh& lattice, std::size_t own_face_count,
                                       const Superquadric& shape, const SphericalGrid& grid,
                                       const std::vector<Vec3d>& sample_points);

} // namespace echinus::rivals
