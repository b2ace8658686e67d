#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>

namespace echinus {

/// Reverses the faces of inside-out components (see RepairOptions::flip_inside_out).
/// @returns how many components were reversed
/// @pre require_valid(mesh)
std::size_t flip_inside_out_components(TriangleMesh& mesh);

} // namespace echinus
