#pragma once

#include <echinus/export.hpp>

#include <cstdint>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The grid by which a distance map divides the directions around its centre.
enum class DirectionGrid : std::uint8_t {
    /// The paper's grid: samples of longitude and colatitude, between which the distance is interpolated
    /// bilinearly. Flat faces become slightly curved, and samples crowd at the poles.
    Spherical,
    /// The faces of an octahedron, divided into small triangles. This grid needs no trigonometry, and the
    /// solid angles of its samples differ by a factor of up to 5.2, compared with 127 for the spherical grid.
    /// It interpolates the reciprocal of the L1 radius |x| + |y| + |z|, which is affine over a flat face, so
    /// that flat faces stay flat.
    Octahedral,
    /// The faces of a cube, evenly spaced in angle (a tangent-warped, or equiangular, cube map): the most
    /// uniform grid, with solid angles that differ by a factor of up to 1.4. The distance is interpolated
    /// bilinearly.
    Cube,
    /// The spherical grid, in a frame whose axes are scaled so that the mesh's box about the centre is a
    /// cube. The samples are then spread evenly over an ellipsoid with the proportions of the mesh. The
    /// interpolated quantity is the distance in the scaled frame, which is constant over that ellipsoid.
    Ellipsoidal,
};

/// True for grids that have poles, and numbers of longitudes and colatitudes instead of divisions.
constexpr bool has_poles(DirectionGrid grid) {
    return grid == DirectionGrid::Spherical || grid == DirectionGrid::Ellipsoidal;
}

/// The axis of the mesh on which the poles of the (longitude, colatitude) grid lie.
enum class PoleAxis : std::uint8_t { X, Y, Z };

/// The point at which the rays of a map start.
enum class CentreChoice : std::uint8_t {
    BoundingSphere, ///< the centre of the smallest enclosing sphere: the smallest radius
    /// The point that is expected to give the better map, found by a search that costs about twenty coarse
    /// builds. For an exact map it is the point with the fewest face tests per query; any centre gives the
    /// same answers. For a distance map it is the point with the fewest wrong answers near the surface. The
    /// farther it is from the sphere's centre, the larger are the radius and the step of the lattice.
    Search,
};

} // namespace echinus

ECHINUS_EXPORT_END
