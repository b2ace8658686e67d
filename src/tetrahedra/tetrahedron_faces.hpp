#pragma once

#include <echinus/tetrahedra.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The face opposite each corner of a positive tetrahedron, counter-clockwise seen from outside it.
inline constexpr std::array<std::array<int, 3>, 4> kFaceCorners{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

Triangle face_opposite(const Tetrahedron& tetrahedron, int corner);

/// One tetrahedron's use of one of its faces.
struct FaceUse {
    Triangle vertices; ///< ascending
    std::uint32_t tetrahedron;
    std::uint8_t corner; ///< the corner opposite the face
    bool is_even;        ///< whether face_opposite() is an even permutation of `vertices`
};

/// All uses of all faces, sorted by face and then by tetrahedron.
/// @throws Error InvalidMesh if an index is out of range or two tetrahedra are on the same side of a face; so
/// each face has at most two uses
std::vector<FaceUse> sorted_face_uses(const TetrahedralMesh& mesh);

/// @throws Error InvalidMesh if there are more tetrahedra than std::uint32_t can count, an index is out of
/// range, or a tetrahedron has two equal corners
void require_indices(const TetrahedralMesh& mesh);

/// The signed volume of a tetrahedron, positive if it is positively oriented; in the cube of the mesh's unit.
inline double tetrahedron_volume(const TetrahedralMesh& mesh, std::size_t number) {
    const Tetrahedron& corners = mesh.tetrahedra[number];
    const Vec3d a(mesh.vertices[corners[0]]);
    const auto way_to = [&](std::size_t i) { return Vec3d(mesh.vertices[corners[i]]) - a; };
    return dot(cross(way_to(1), way_to(2)), way_to(3)) / 6;
}

} // namespace echinus
