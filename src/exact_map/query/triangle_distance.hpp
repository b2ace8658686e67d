#pragma once

#include "exact_map/query/triangle.hpp"

/// The distance of two triangles, from below.
namespace echinus {

/// A number not above the distance of two closed triangles, whatever is rounded, and mostly below it by no
/// more than rounding: the gap between them along the line of their nearest points. 0 where they meet.
/// @param rounding  how far off a coordinate may be, with what adds up from it: all that depends on it is
/// taken
///                  off the result
double distance_from_below(const TriangleCorners& a, const TriangleCorners& b, double rounding) noexcept;

} // namespace echinus
