#pragma once

#include <echinus/mesh.hpp>

#include <vector>

namespace echinus {

/// [vertex_count] does a face use the vertex? Others may be anything, even NaN.
/// @pre indices are in range
std::vector<bool> is_vertex_used(const TriangleMesh& mesh);

/// The positions of the vertices that faces use.
std::vector<Vec3f> used_positions(const TriangleMesh& mesh);

} // namespace echinus
