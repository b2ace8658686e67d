#pragma once

#include "directions/lattice.hpp"
#include "geometry/triangle.hpp"

#include <cmath>
#include <optional>

namespace echinus {

// The distance of two triangles, from below.

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

// When a moving triangle first comes to one that stands.

/// A triangle whose corners each move along a straight line, at the same time.
struct MovingTriangle {
    TriangleCorners from, way;

    TriangleCorners at(double fraction) const {
        return {from[0] + way[0] * fraction, from[1] + way[1] * fraction, from[2] + way[2] * fraction};
    }
};

/// How near a moving triangle must come, and by how much it may be off.
struct ArrivalTolerance {
    double reach;          ///< lattice steps; more than 2^-47 of the longest way
    double rounded_extent; ///< see rounding_of()
};

/// A fraction of the way within `reach` of a standing triangle, before which the triangles do not meet; none
/// where they do not meet up to `last`. The same for every `last` that is not before it.
///
/// Conservative advancement (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996) by planes
/// in place of speeds: across the widest gap at a time, the triangles stay apart until the first corner has
/// come to the plane through the standing one, which each does at its own speed towards the plane, if at all.
/// So what slides along a surface or leaves it is done in one move.
///
/// Cost: at most 2 + 2 log2(L / reach) moves, each a distance of two triangles, where the ways of corners in
/// what is left differ by W <= reach / 2. L is the longest way. Say a move begins with a gap g that closes at
/// a speed s, and takes the time g / s or more; the next begins with g' and s'. Across the second gap the
/// triangles were no more than g apart when the first move began, and each corner comes nearer at s' - W or
/// more: g' + (s' - W) g / s <= g. With s' >= 2 W it follows that g' / g + s' / (2 s) <= 1, hence
/// g' s' <= g s / 2; below that, a gap of more than reach lasts to the end. And g s is at most L^2 in the
/// beginning, unless the first move is the last one, and more than reach^2 before each further move.
/// A triangle whose corners move more differently is halved after a few moves, and its halves likewise: those
/// that are far from the standing triangle, for their size, need few moves.
std::optional<double> arrival(const MovingTriangle& moving, const TriangleCorners& standing, double start,
                              double last, const ArrivalTolerance& tolerance) noexcept;

} // namespace echinus
