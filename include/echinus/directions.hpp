#pragma once

#include <echinus/export.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// How a distance map divides the directions around its centre.
enum class DirectionGrid : std::uint8_t {
    /// The paper's: samples of longitude and colatitude, and between them bilinear interpolation of the
    /// distance. Flat faces come out slightly bent; samples crowd at the poles.
    Spherical,
    /// The sides of an octahedron, cut into small triangles: no trigonometry, samples 5.2 : 1 in solid angle
    /// where the spherical ones are 127 : 1. Interpolated is the reciprocal of the L1 radius |x| + |y| + |z|,
    /// which is affine over a flat face, so that flat faces stay flat.
    Octahedral,
    /// The sides of a cube, evenly spaced in angle (a tangent-warped, or equiangular, cube map): the evenest
    /// grid, samples 1.4 : 1 in solid angle. Interpolated is the distance, bilinearly.
    Cube,
    /// The spherical grid after the axes of the mesh were scaled until its box about the centre is a cube, so
    /// that an ellipsoid as long and as thin as the mesh gets its samples evenly. Interpolated is the
    /// distance
    /// in the scaled frame, which is constant over that ellipsoid.
    Ellipsoidal,
};

/// Has the grid poles, and counts of longitudes and colatitudes rather than divisions?
constexpr bool has_poles(DirectionGrid grid) {
    return grid == DirectionGrid::Spherical || grid == DirectionGrid::Ellipsoidal;
}

/// Which axis of the mesh the poles of the (longitude, colatitude) grid lie on.
enum class PoleAxis : std::uint8_t { X, Y, Z };

/// Where the rays of a map start.
enum class CentreChoice : std::uint8_t {
    BoundingSphere, ///< the centre of the smallest enclosing sphere: the smallest radius
    /// The place that promises the better map, by a search that costs some twenty coarse builds. The radius
    /// grows with its distance from the sphere's centre. Of an exact map: that with the fewest face tests per
    /// query; any centre gives the same answers, and the lattice is coarser as the radius is larger. Of a
    /// distance map: that with the fewest wrong answers beside the surface.
    Search,
};

} // namespace echinus

ECHINUS_EXPORT_END
