#pragma once

#include "directions/lattice.hpp"
#include "geometry/triangle.hpp"

#include <cmath>

/// The distance of two triangles, from below.
namespace echinus {

/// A gap between two closed triangles, bounded by two parallel planes.
struct TriangleGap {
    Vec3d direction; ///< across the planes, towards the first triangle; not of length 1
    double width = 0;
};

/// The gap along the line of the nearest points of two triangles, as wide as they are apart but for rounding;
/// 0 where they meet.
TriangleGap gap_between(const TriangleCorners& a, const TriangleCorners& b) noexcept;

/// A number not above the distance of two closed triangles, whatever is rounded, and mostly below it by no
/// more than rounding: the gap between them along the line of their nearest points. 0 where they meet.
/// @param rounding  how far off a coordinate may be, with what adds up from it: all that depends on it is
/// taken
///                  off the result
double distance_from_below(const TriangleCorners& a, const TriangleCorners& b, double rounding) noexcept;

/// The sum of coordinates without their signs.
inline double extent_of(const Vec3d& v) {
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

/// More than the coordinates of a triangle and of faces are off, in lattice steps, with all that
/// distance_from_below() makes of them: 2^-46 of their sum.
/// @param rounded_extent  of what was rounded to get the corners, such as the frame's centre
inline double rounding_of(const TriangleCorners& corners, double rounded_extent) {
    return (extent_of(corners[0]) + extent_of(corners[1]) + extent_of(corners[2]) + rounded_extent +
            3.0 * static_cast<double>(kLatticeExtent)) *
           0x1p-46;
}

} // namespace echinus
