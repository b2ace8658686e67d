#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// In place of the number of a face: there is none.
inline constexpr std::uint32_t kNoFace = UINT32_MAX;

/// Are two of the three indices equal?
bool has_equal_corners(const Triangle& face);

/// Six times the signed volume of the tetrahedron of a reference point and a face: positive if the face
/// points away from the point.
/// @pre indices are in range
double six_volumes(const TriangleMesh& mesh, const Triangle& face, const Vec3d& reference);

/// The sets of two or more faces that have the same three vertices in any order; each set is ascending.
std::vector<std::vector<std::uint32_t>> find_equal_faces(const TriangleMesh& mesh);

/// The faces that have the same three vertices, in any order, as a face before them; ascending.
std::vector<std::uint32_t> find_duplicate_faces(const TriangleMesh& mesh);

/// The faces with two equal corners or with area zero (as computed in double: exact unless the coordinates of
/// a face differ by a factor of more than 2^28); ascending.
/// @pre indices are in range
std::vector<std::uint32_t> find_degenerate_faces(const TriangleMesh& mesh);

/// The use of an edge by one of its faces. Edge k of a face runs from corner k to the next.
struct EdgeUse {
    std::uint32_t low; ///< the smaller of the edge's two vertices
    std::uint32_t high;
    std::uint32_t face;
    std::uint8_t corner;
    bool ascending; ///< the face runs from low to high
};

/// All uses of all edges, sorted by edge and then by face. Faces with two equal corners have no boundary and
/// contribute nothing.
/// @pre indices are in range
std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> faces);
inline std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
    return sorted_edge_uses(mesh.faces);
}

/// The uses of the edge between two vertices in the result of sorted_edge_uses().
std::span<const EdgeUse> uses_of_edge(std::span<const EdgeUse> all, std::uint32_t a, std::uint32_t b);

/// Do equally many faces run along the edge in each direction? If so, they cancel, and the edge is no border.
bool is_balanced(std::span<const EdgeUse> uses_of_one_edge);

/// Calls visit(uses of one edge) for each edge in turn.
template <typename Visit>
void for_each_edge(std::span<const EdgeUse> all, Visit&& visit) {
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        while (end < all.size() && all[end].low == all[begin].low && all[end].high == all[begin].high) ++end;
        visit(all.subspan(begin, end - begin));
    }
}

/// Sets of faces that are connected by shared vertices.
struct Components {
    std::size_t count = 0;
    std::vector<std::uint32_t> of_face; ///< [face_count] numbered in the order of their first faces
};

/// @pre indices are in range
Components find_components(const TriangleMesh& mesh);

/// The relative orientation of faces across edges with exactly two faces. Faces connected by such edges form
/// a patch.
struct Orientation {
    std::vector<std::uint32_t> patch_of_face; ///< [face_count] numbered in the order of their first faces
    std::vector<bool> is_turned;              ///< [face_count] runs opposite to the first face of its patch
    std::vector<bool> is_orientable; ///< [patch_count] all paths between two faces agree about is_turned
    std::vector<bool> is_closed;     ///< [patch_count] orientable, and by itself a closed surface
};

/// Time O(faces).
/// @param edge_uses  sorted_edge_uses() of the faces
Orientation find_orientation(std::span<const EdgeUse> edge_uses, std::size_t face_count);

/// Which of the sets into which faces are divided are closed surfaces by themselves: along each edge equally
/// many faces of the set run in each direction. Time O(faces).
/// @param is_turned  [face_count] faces whose orientation counts as reversed; empty for none
std::vector<bool> find_closed_sets(std::span<const EdgeUse> edge_uses,
                                   std::span<const std::uint32_t> set_of_face, std::size_t set_count,
                                   const std::vector<bool>& is_turned = {});

/// winding_number() of some faces only.
double winding_number(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& point);

} // namespace echinus
