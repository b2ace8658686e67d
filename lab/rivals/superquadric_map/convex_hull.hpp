#pragma once

#include <echinus/mesh.hpp>

#include <span>
#include <vector>

namespace echinus::rivals {

/// The faces of the convex hull of points: closed, counter-clockwise seen from outside, corners numbered as
/// the points. By Bullet's exact integers (btConvexHullComputer, after Preparata and Hong 1977), to which
/// points are rounded in steps of 1e-4 of their extent. Points in one plane give a sheet of two sides; on one
/// line, nothing.
/// @pre positions are finite
std::vector<Triangle> convex_hull(std::span<const Vec3f> points);

} // namespace echinus::rivals
