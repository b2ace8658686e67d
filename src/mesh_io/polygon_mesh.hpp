#pragma once

#include "mesh_io/mesh_source.hpp"

#include <echinus/mesh.hpp>

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

} // namespace echinus
