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

/// Makes the boundary manifold by removing tetrahedra. If parts of the body are connected only by an edge or
/// a vertex, the largest part stays and the others lose the tetrahedra there; if two hollows meet at a
/// vertex, all tetrahedra at that vertex are removed. This is repeated until there is no such edge or vertex.
/// Vertices are kept, used or not.
/// @returns how many tetrahedra were removed
std::size_t remove_pinches(TetrahedralMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
