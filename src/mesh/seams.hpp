#pragma once

#include <echinus/export.hpp>
#include <echinus/geometry.hpp>
#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Is every edge balanced, as MeshReport::closed defines it? Positions do not matter. Time O(faces), except
/// O(n log n) at vertices with many edges.
/// @pre indices are below vertex_count
bool is_closed(std::span<const Triangle> faces, std::size_t vertex_count);

// A seam is an edge at which the faces on either side have corners of their own that coincide except for
// rounding. Seams are not holes. inspect() and all maps identify such corners by the same rule, so that they
// agree on which meshes are closed.

/// How far apart two corners of a seam may be: a quarter of a lattice step (directions/lattice.hpp). That is
/// what rounding to the lattice leaves of the two steps that docs/accuracy.md promises, and about the
/// resolution of float at four radii from the origin.
inline double seam_width(double bounding_radius) {
    return bounding_radius * 0x1p-21;
}

/// The vertices, ascending, on edges along which more faces run in one direction than in the other; none for
/// a closed mesh. Vertices are distinguished by index. Time O(n log n); for a closed mesh, the time of
/// is_closed().
/// @pre indices are below vertex_count
std::vector<std::uint32_t> find_open_vertices(std::span<const Triangle> faces, std::size_t vertex_count);

/// For each of some vertices, the first of them that is within the width and represents itself. So vertices
/// that represent themselves are farther apart than the width, however long a chain of near vertices is.
/// @param vertices  all vertices to which the numbers refer
/// @param open      [n] ascending numbers of vertices that are finite
/// @returns  [n]
std::vector<std::uint32_t> join_near_vertices(std::span<const Vec3f> vertices,
                                              std::span<const std::uint32_t> open, double width);

/// A copy in which faces on both sides of seams have common corners. The list of vertices is unchanged.
/// @pre require_valid(mesh)
TriangleMesh with_common_corners(const TriangleMesh& mesh, double width);

} // namespace echinus

ECHINUS_EXPORT_BEGIN

namespace echinus {

struct WeldedMesh {
    TriangleMesh mesh;
    /// [vertex_count] For each vertex, the first vertex of the input at the same position.
    std::vector<std::uint32_t> sources;
};

/// weld() for callers that have data at vertices in addition to positions.
/// @throws Error InvalidMesh as weld() does
WeldedMesh weld_with_sources(const TriangleMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
