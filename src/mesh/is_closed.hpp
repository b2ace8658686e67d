#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <span>

namespace echinus {

/// Is every edge balanced, as MeshReport::closed says? Wherever the vertices are. Time O(faces), but for
/// vertices with many edges, O(n log n).
/// @pre indices are below vertex_count
bool is_closed(std::span<const Triangle> faces, std::size_t vertex_count);

} // namespace echinus
