#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <span>

namespace echinus {

/// Is every edge balanced, as MeshReport::closed defines it? Positions do not matter. Time O(faces), except
/// O(n log n) at vertices with many edges.
/// @pre indices are below vertex_count
bool is_closed(std::span<const Triangle> faces, std::size_t vertex_count);

} // namespace echinus
