#pragma once

#include <echinus/mesh.hpp>

#include <array>
#include <vector>

namespace echinus {

/// Unit normals at the three corners of a face.
using CornerNormals = std::array<Vec3f, 3>;

/// Shading normals per face corner, [face_count]: the mean of the normals of the faces around the vertex
/// whose angle with this face is below the crease angle, each weighted by its corner angle at the vertex
/// (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", 1998). Faces without area get (0,
/// 0, 0).
/// @pre indices are in range, coordinates finite and of moderate size
std::vector<CornerNormals> corner_normals(const TriangleMesh& mesh, double crease_angle_deg);

/// Unit normal of one face, in double; (0, 0, 0) when it has no area.
Vec3d face_normal(const TriangleMesh& mesh, const Triangle& face);

} // namespace echinus
