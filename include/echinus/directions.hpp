#pragma once

#include <cstdint>

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
};

/// The largest L1 radius |x| + |y| + |z| in a ball of radius 1: a little more than sqrt(3).
inline constexpr float kLargestL1Radius = 1.7320509F;

/// Which axis of the mesh the poles of the (longitude, colatitude) grid lie on.
enum class PoleAxis : std::uint8_t { X, Y, Z };

} // namespace echinus
