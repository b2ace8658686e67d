#pragma once

#include <echinus/export.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// How a distance map divides the directions around its centre.
enum class DirectionGrid : std::uint8_t {
    /// The paper's: samples of longitude and colatitude, and the distance interpolated bilinearly between
    /// them. Flat faces come out slightly bent; samples crowd at the poles.
    Spherical,
    /// The sides of an octahedron, cut into small triangles: no trigonometry, solid angles of samples differ
    /// by 5.2 : 1, where those of the spherical grid differ by 127 : 1. The reciprocal of the L1 radius
    /// |x| + |y| + |z| is interpolated, which is affine over a flat face, so that flat faces stay flat.
    Octahedral,
    /// The sides of a cube, evenly spaced in angle (a tangent-warped, or equiangular, cube map): the most
    /// even grid, with solid angles that differ by 1.4 : 1. The distance is interpolated, bilinearly.
    Cube,
    /// The spherical grid after the axes of the mesh were scaled until its box about the centre is a cube, so
    /// that the samples are spread evenly over an ellipsoid as long and as thin as the mesh. The distance in
    /// the scaled frame is interpolated, which is constant over that ellipsoid.
    Ellipsoidal,
};

/// True for grids that have poles, and counts of longitudes and colatitudes instead of divisions.
constexpr bool has_poles(DirectionGrid grid) {
    return grid == DirectionGrid::Spherical || grid == DirectionGrid::Ellipsoidal;
}

/// Which axis of the mesh the poles of the (longitude, colatitude) grid lie on.
enum class PoleAxis : std::uint8_t { X, Y, Z };

/// Where the rays of a map start.
enum class CentreChoice : std::uint8_t {
    BoundingSphere, ///< the centre of the smallest enclosing sphere: the smallest radius
    /// The place that promises the better map, found by a search that costs some twenty coarse builds. For an
    /// exact map, the place with the fewest face tests per query; any centre gives the same answers. For a
    /// distance map, the place with the fewest wrong answers close to the surface. The farther it is from the
    /// sphere's centre, the larger the radius, and with it the step of the lattice.
    Search,
};

} // namespace echinus

ECHINUS_EXPORT_END
