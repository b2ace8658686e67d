#pragma once

#include <echinus/export.hpp>
#include <echinus/tetrahedra.hpp>

#include <cstddef>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Exchanges two corners of each negative tetrahedron.
/// @returns how many there were
/// @pre indices are in range and vertices finite
std::size_t turn_negative(TetrahedralMesh& mesh);

/// Drops the vertices that no tetrahedron uses; the others keep their order.
/// @returns how many were dropped
/// @pre indices are in range
std::size_t drop_unused_vertices(TetrahedralMesh& mesh);

/// Makes the boundary manifold by removing tetrahedra: where parts of the body meet in no more than an edge
/// or a vertex, the largest stays and the others lose the tetrahedra there; where two hollows meet in a
/// vertex, its tetrahedra go. Repeats this until there is no such place. Vertices stay, used or not.
/// @returns how many tetrahedra were removed
std::size_t remove_pinches(TetrahedralMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
