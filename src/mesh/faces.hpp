#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// Two of the three indices are the same.
bool has_equal_corners(const Triangle& face);

/// Six times the signed volume of the tetrahedron of a reference point and a face: positive where the face
/// looks away from the point.
/// @pre indices are in range
double six_volumes(const TriangleMesh& mesh, const Triangle& face, const Vec3d& reference);

/// The sets of two or more faces that have the same three vertices, in any order; each set ascending.
std::vector<std::vector<std::uint32_t>> find_equal_faces(const TriangleMesh& mesh);

/// The faces that have the same three vertices, in any order, as an earlier face; ascending.
std::vector<std::uint32_t> find_duplicate_faces(const TriangleMesh& mesh);

/// The faces with two equal corners or with area zero (as computed in double: exact unless the coordinates of
/// a face differ by a factor of more than 2^28); ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_degenerate_faces(const TriangleMesh& mesh);

} // namespace echinus
