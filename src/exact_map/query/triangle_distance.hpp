#pragma once

#include "directions/lattice.hpp"
#include "geometry/triangle.hpp"

#include <cmath>
#include <optional>

namespace echinus {

// Lower bounds of the distance between two triangles.

/// A gap between two closed triangles, bounded by two parallel planes.
struct TriangleGap {
    Vec3d direction; ///< across the planes, towards the first triangle; not of unit length
    double width = 0;
};

/// The gap along the line of the nearest points of two triangles. Its width is their distance, except for
/// rounding; 0 if they meet.
TriangleGap gap_between(const TriangleCorners& a, const TriangleCorners& b) noexcept;

/// A number that never exceeds the distance of two closed triangles, whatever is rounded, and is mostly below
/// it only by rounding: the gap between them along the line of their nearest points; 0 if they meet.
/// @param rounding  the error of a coordinate, including the errors that arise from it; all that depends on
///                  it is subtracted from the result
double distance_from_below(const TriangleCorners& a, const TriangleCorners& b, double rounding) noexcept;

/// The sum of the absolute coordinates.
inline double extent_of(const Vec3d& v) {
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

/// An upper bound, in lattice steps, of the errors in the coordinates of a triangle and of faces and of the
/// errors that distance_from_below() adds: 2^-46 of the sum of the coordinates.
/// @param rounded_extent  the sum of further values that were rounded to obtain the corners, such as the
///                        frame's centre
inline double rounding_of(const TriangleCorners& corners, double rounded_extent) {
    return (extent_of(corners[0]) + extent_of(corners[1]) + extent_of(corners[2]) + rounded_extent +
            3.0 * static_cast<double>(kLatticeExtent)) *
           0x1p-46;
}

// The time at which a moving triangle first reaches a stationary one.

/// A triangle whose corners move simultaneously, each along a straight line.
struct MovingTriangle {
    TriangleCorners from, way;

    TriangleCorners at(double fraction) const {
        return {from[0] + way[0] * fraction, from[1] + way[1] * fraction, from[2] + way[2] * fraction};
    }
};

/// How near a moving triangle must come to count as arrived, and what its rounding errors depend on.
struct ArrivalTolerance {
    double reach;          ///< lattice steps; more than 2^-47 of the longest displacement
    double rounded_extent; ///< see rounding_of()
};

/// A fraction of the motion at which the triangles are within `reach` of each other and before which they do
/// not meet; nothing if they do not meet up to `last`. The result is the same for every `last` that is not
/// before it.
///
/// Conservative advancement (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems, 1996) with
/// planes in place of speeds: across the widest gap at a time, the triangles stay apart until the first
/// corner has reached the plane through the stationary one; each corner moves towards the plane at its own
/// speed, if at all. So a triangle that slides along a surface or leaves it is finished in one move.
///
/// Cost: at most 2 + 2 log2(L / reach) moves, each with one distance of two triangles, if the displacements
/// of the corners over the rest of the motion differ by W <= reach / 2. L is the longest displacement.
/// Suppose a move begins with a gap g that closes at speed s, and takes the time g / s or more; the next
/// begins with g' and s'. Across the second gap the triangles were no more than g apart when the first move
/// began, and each corner approaches at s' - W or more: g' + (s' - W) g / s <= g. With s' >= 2 W it follows
/// that g' / g + s' / (2 s) <= 1, hence g' s' <= g s / 2; below that, a gap of more than `reach` lasts to the
/// end. And g s is at most L^2 at first, unless the first move is the last one, and more than reach^2 before
/// each further move. If the displacements differ more, the triangle is halved after a few moves, and its
/// halves likewise: those that are far from the stationary triangle for their size need few moves.
std::optional<double> arrival(const MovingTriangle& moving, const TriangleCorners& standing, double start,
                              double last, const ArrivalTolerance& tolerance) noexcept;

} // namespace echinus
