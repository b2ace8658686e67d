#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>

namespace echinus {

/// @throws Error InvalidMesh when one of the face's indices is out of range; the sentence names both the face
/// and the index.
void require_vertices_exist(const TriangleMesh& mesh, std::size_t face);

} // namespace echinus
