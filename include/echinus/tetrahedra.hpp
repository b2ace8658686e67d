#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Solids cut into tetrahedra.
namespace echinus {

/// Four vertex indices a, b, c, d. *Positive*: a, b, c turn counter-clockwise seen from d, so that the volume
/// (b - a) x (c - a) . (d - a) / 6 is positive.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// A body cut into tetrahedra that share vertices. It has no invariants; require_valid() tells whether every
/// other function takes it.
struct TetrahedralMesh {
    std::vector<Vec3f> vertices;         ///< [vertex_count] positions in the caller's unit
    std::vector<Tetrahedron> tetrahedra; ///< [tetrahedron_count]
};

/// Each tetrahedron is positive, and two that share a face lie on either side of it. Vertices that no
/// tetrahedron uses may be anything. Signs are exact. Time O(n log n).
/// @throws Error InvalidMesh when there is no tetrahedron, an index is out of range, a used vertex is not
/// finite, a tetrahedron is flat or negative, or two lie on the same side of a face of theirs; the sentence
/// names the first
void require_valid(const TetrahedralMesh& mesh);

/// The faces that belong to one tetrahedron only, outward, in the order of the tetrahedra. The vertices are
/// those of the body with their numbers, also the inner ones, which no face uses. Closed; and manifold unless
/// tetrahedra of the body meet in no more than an edge or a vertex. Time O(n log n).
/// @throws Error InvalidMesh when an index is out of range, or two tetrahedra lie on the same side of a face
TriangleMesh boundary(const TetrahedralMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
