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

// Seams: where the faces on either side of a surface's edge have corners of their own, which coincide but
// for rounding. They are no holes. inspect() and all maps take such corners for one, by the same rule, so
// that they agree on what is closed.

/// How far apart two corners of a seam may be: a quarter of a lattice step (directions/lattice.hpp), which is
/// what rounding to the lattice leaves of the two steps that docs/accuracy.md promises, and about what float
/// resolves four radii from the origin.
inline double seam_width(double bounding_radius) {
    return bounding_radius * 0x1p-21;
}

/// The vertices, ascending, on edges along which more faces run one way than the other: none of a closed
/// mesh. Vertices are distinguished by index. Time O(n log n), for a closed mesh that of is_closed().
/// @pre indices are below vertex_count
std::vector<std::uint32_t> find_open_vertices(std::span<const Triangle> faces, std::size_t vertex_count);

/// For each of some vertices the first of them that is no farther away than the width and stands for itself.
/// So those that stand for themselves are farther apart, however long a chain of near ones is.
/// @param vertices  all that the numbers refer to
/// @param open      [n] ascending numbers of vertices that are finite
/// @returns  [n]
std::vector<std::uint32_t> join_near_vertices(std::span<const Vec3f> vertices,
                                              std::span<const std::uint32_t> open, double width);

/// A copy in which faces on seams have common corners. Vertices stay as they are.
/// @pre require_valid(mesh)
TriangleMesh with_common_corners(const TriangleMesh& mesh, double width);

} // namespace echinus

ECHINUS_EXPORT_BEGIN

namespace echinus {

struct WeldedMesh {
    TriangleMesh mesh;
    /// [vertex_count] for each vertex the first one of the input that stands there.
    std::vector<std::uint32_t> sources;
};

/// weld(), for those who have more to say about the vertices than where they stand.
/// @throws Error InvalidMesh as weld() does
WeldedMesh weld_with_sources(const TriangleMesh& mesh);

} // namespace echinus

ECHINUS_EXPORT_END
