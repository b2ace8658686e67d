#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>

namespace echinus {

/// Faces of a mesh whose corners can still be numbered in 32 bits; int32 then names a face, too.
inline constexpr std::size_t kMostFaces = std::size_t{1} << 30;

/// @throws Error InvalidMesh for more faces, or more vertices than they have corners. Code that counts faces,
/// corners or vertices of a mesh in 32 bits asks this first, as require_valid() and LatticeSnapper do.
void require_numberable(std::size_t face_count, std::size_t vertex_count);

/// @throws Error InvalidMesh when one of the face's indices is out of range; the sentence names both the face
/// and the index.
void require_vertices_exist(const TriangleMesh& mesh, std::size_t face);

} // namespace echinus
