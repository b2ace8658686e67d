#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// The vertices around a hole, three or more and each once, in the order in which the faces that fill it run.
using HoleLoop = std::vector<std::uint32_t>;

/// The edges along which more faces run one way than the other, as loops. They always form loops, since the
/// edges of every single face do. Loops that touch at a vertex are parted there; where they touch at several,
/// one of the ways to part them is taken. The same mesh gives the same loops. Time O(n log n).
/// @pre indices are in range
std::vector<HoleLoop> find_hole_loops(const TriangleMesh& mesh);

} // namespace echinus
