#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The most faces of a mesh: their corners can still be numbered in 32 bits, and an int32 can name a face.
inline constexpr std::size_t kMostFaces = std::size_t{1} << 30;

/// @throws Error InvalidMesh if there are more faces than kMostFaces, or more vertices than that many faces
/// have corners. Code that counts faces, corners or vertices of a mesh in 32 bits must call this first, as
/// require_valid() and LatticeSnapper do.
void require_numberable(std::size_t face_count, std::size_t vertex_count);

/// @throws Error InvalidMesh if one of the face's indices is out of range; the message names the face and the
/// index.
void require_vertices_exist(const TriangleMesh& mesh, std::size_t face);

/// Which vertices the faces of a mesh use; the others may have any coordinates, even NaN. Depends only on the
/// faces, not on positions.
class UsedVertices {
  public:
    UsedVertices(std::span<const Triangle> faces, std::size_t vertex_count);

    std::size_t vertex_count() const { return is_used_.size(); }
    bool operator[](std::size_t vertex) const { return is_used_[vertex] != 0; }

    /// Throws the error of echinus::require_valid() for these vertices and the faces. Time O(vertices).
    /// @pre vertices.size() == vertex_count(); the faces are those of the constructor
    void require_valid(std::span<const Vec3f> vertices, std::span<const Triangle> faces) const;

    /// The positions of the vertices that faces use, ascending by number.
    /// @param memory  receives the positions if they are not contiguous in `vertices`
    /// @pre vertices.size() == vertex_count()
    std::span<const Vec3f> positions(std::span<const Vec3f> vertices, std::vector<Vec3f>& memory) const;

  private:
    std::vector<std::uint8_t> is_used_; ///< [vertex_count]
    bool all_used_ = true;
    bool in_range_ = true; ///< whether all vertex numbers in faces are below vertex_count
};

/// The positions of the vertices that faces use.
/// @pre indices are in range
std::vector<Vec3f> used_positions(const TriangleMesh& mesh);

} // namespace echinus
