#pragma once

#include <echinus/tetrahedra.hpp>

#include <cstddef>

namespace echinus {

/// Makes the boundary manifold by removing tetrahedra: where parts of the body meet in no more than an edge
/// or a vertex, the largest stays and the others lose the tetrahedra there; where two hollows meet in a
/// vertex, its tetrahedra go. Repeats this until there is no such place. Vertices stay, used or not.
/// @returns how many tetrahedra were removed
std::size_t remove_pinches(TetrahedralMesh& mesh);

} // namespace echinus
