#pragma once

#include "mesh_io/mesh_source.hpp"

#include <echinus/mesh.hpp>
#include <echinus/mesh_io.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// The contents of a file: vertices, and polygons with any number of corners; those of two are edges.
struct PolygonMesh {
    std::vector<Vec3d> vertices;              ///< finite as floats, too
    std::vector<std::uint32_t> corners;       ///< vertex indices, in range, polygon after polygon
    std::vector<std::uint32_t> corner_counts; ///< [polygon_count]
};

/// Concave polygons with more corners are refused: the time to cut them grows with a power of the number.
inline constexpr std::uint32_t kMaxConcaveCorners = 4096;

/// Moves the vertices to a local origin where that is needed (mesh/local_frame.hpp), and cuts each polygon of
/// k corners into k - 2 triangles, in order; points and lines are left out. Strictly convex polygons become
/// fans around their first corner, others lose ears (Meisters, "Polygons have ears", 1975) as seen along
/// their normal. Where a polygon meets itself and has no ear left, the rest becomes a fan.
/// @throws Error InvalidMesh, in the name of `source`
TriangleMesh triangulate(const PolygonMesh& polygons, const MeshSource& source);

// One reader per kind of file.
//
// All of them throw Error WrongFormat, Damaged or InvalidMesh; vertices are finite and indices in range.

PolygonMesh read_obj(const MeshSource& source);
PolygonMesh read_off(const MeshSource& source);
PolygonMesh read_ply(const MeshSource& source);
PolygonMesh read_stl(const MeshSource& source);

/// glTF, GLB and 3DS. A glTF file's buffers are looked for beside it.
PolygonMesh read_scene(const MeshSource& source);

/// Parts of require_beginning(), below. The head of a binary STL file states its size.
void require_beginning_of_stl(const MeshSource& beginning);
void require_beginning_of_gltf(const MeshSource& beginning);
void require_beginning_of_glb(const MeshSource& beginning);
void require_beginning_of_3ds(const MeshSource& beginning);

/// read_mesh() for the bytes of a file; the extension of the source's name determines the format.
TriangleMesh read_mesh(const MeshSource& source);
MeshAndEdges read_mesh_and_edges(const MeshSource& source);

/// Refuses the first bytes of a stream when read_mesh() would refuse it whatever followed them, so that a
/// stream without an end is not read up to a limit.
/// @pre beginning.bytes.size() >= 84, the head of a binary STL file
/// @throws Error WrongFormat or Damaged
void require_beginning(const MeshSource& beginning);

} // namespace echinus
