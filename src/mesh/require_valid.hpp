#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Faces of a mesh whose corners can still be numbered in 32 bits; int32 then names a face, too.
inline constexpr std::size_t kMostFaces = std::size_t{1} << 30;

/// @throws Error InvalidMesh for more faces, or more vertices than they have corners. Code that counts faces,
/// corners or vertices of a mesh in 32 bits asks this first, as require_valid() and LatticeSnapper do.
void require_numberable(std::size_t face_count, std::size_t vertex_count);

/// @throws Error InvalidMesh when one of the face's indices is out of range; the sentence names both the face
/// and the index.
void require_vertices_exist(const TriangleMesh& mesh, std::size_t face);

/// Which vertices the faces of a mesh use; the others may be anything, even NaN. Needs the faces only, no
/// positions.
class UsedVertices {
  public:
    UsedVertices(std::span<const Triangle> faces, std::size_t vertex_count);

    std::size_t vertex_count() const { return is_used_.size(); }
    bool operator[](std::size_t vertex) const { return is_used_[vertex] != 0; }

    /// Throws the error of echinus::require_valid() for these vertices and the faces. Time O(vertices).
    /// @pre vertices.size() == vertex_count(); the faces are those of the constructor
    void require_valid(std::span<const Vec3f> vertices, std::span<const Triangle> faces) const;

    /// The positions of the vertices that faces use, ascending by number.
    /// @param memory  holds them where they are not contiguous
    /// @pre vertices.size() == vertex_count()
    std::span<const Vec3f> positions(std::span<const Vec3f> vertices, std::vector<Vec3f>& memory) const;

  private:
    std::vector<std::uint8_t> is_used_; ///< [vertex_count]
    bool all_used_ = true;
    bool in_range_ = true; ///< all numbers in faces are below vertex_count
};

/// The positions of the vertices that faces use.
/// @pre indices are in range
std::vector<Vec3f> used_positions(const TriangleMesh& mesh);

} // namespace echinus
