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

} // namespace echinus

ECHINUS_EXPORT_END
