#pragma once

#include <echinus/exact_map_view.hpp>
#include <echinus/mesh.hpp>

#include <span>
#include <vector>

namespace echinus {

/// Triangles that close an open surface: with its faces, equally many triangles run along every edge in both
/// directions. The border is taken apart into loops, and each loop is halved again and again, so that most
/// triangles are as short as the border's edges. Those without area are left out. Time O(n log n).
/// @param border    of whole loops, as find_border() finds it; what leads nowhere is left open
/// @param vertices  on the lattice
std::vector<Triangle> cap_border(std::span<const BorderEdge> border,
                                 std::span<const Vec3<std::int32_t>> vertices);

} // namespace echinus
