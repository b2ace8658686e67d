#include "tetrahedra/tetrahedron_faces.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

namespace echinus {

namespace {

FaceUse use_of(const Tetrahedron& tetrahedron, std::uint32_t number, int corner) {
    Triangle face = face_opposite(tetrahedron, corner);
    bool is_even = true;
    const auto order = [&](int i, int j) {
        if (face[i] <= face[j]) return;
        std::swap(face[i], face[j]);
        is_even = !is_even;
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return {face, number, static_cast<std::uint8_t>(corner), is_even};
}

void require_two_sides(const std::vector<FaceUse>& uses) {
    for (std::size_t i = 1; i < uses.size(); ++i)
        for (std::size_t j = i; j > 0 && uses[j - 1].vertices == uses[i].vertices; --j)
            if (uses[j - 1].is_even == uses[i].is_even)
                throw Error(
                    ErrorCode::InvalidMesh,
                    "the tetrahedra " + std::to_string(uses[j - 1].tetrahedron) + " and " +
                        std::to_string(uses[i].tetrahedron) +
                        " lie on the same side of a common face, so they overlap; divide the body into "
                        "tetrahedra again");
}

} // namespace

Triangle face_opposite(const Tetrahedron& tetrahedron, int corner) {
    const auto& corners = kFaceCorners[corner];
    return {tetrahedron[corners[0]], tetrahedron[corners[1]], tetrahedron[corners[2]]};
}

void require_indices(const TetrahedralMesh& mesh) {
    if (mesh.tetrahedra.size() >= std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorCode::InvalidMesh, "there are " + std::to_string(mesh.tetrahedra.size()) +
                                                " tetrahedra, more than 32 bits can number");
    for (std::size_t number = 0; number < mesh.tetrahedra.size(); ++number) {
        const Tetrahedron& corners = mesh.tetrahedra[number];
        for (const std::uint32_t vertex : corners) {
            if (vertex >= mesh.vertices.size())
                throw Error(ErrorCode::InvalidMesh,
                            "tetrahedron " + std::to_string(number) + " refers to vertex " +
                                std::to_string(vertex) + ", but there are " +
                                std::to_string(mesh.vertices.size()) + " vertices, numbered from 0");
            if (std::count(corners.begin(), corners.end(), vertex) > 1)
                throw Error(ErrorCode::InvalidMesh, "tetrahedron " + std::to_string(number) + " has vertex " +
                                                        std::to_string(vertex) + " twice; leave it out");
        }
    }
}

std::vector<FaceUse> sorted_face_uses(const TetrahedralMesh& mesh) {
    require_indices(mesh);
    std::vector<FaceUse> uses;
    uses.reserve(4 * mesh.tetrahedra.size());
    for (std::uint32_t number = 0; number < mesh.tetrahedra.size(); ++number)
        for (int corner = 0; corner < 4; ++corner)
            uses.push_back(use_of(mesh.tetrahedra[number], number, corner));
    std::sort(uses.begin(), uses.end(), [](const FaceUse& a, const FaceUse& b) {
        return std::tie(a.vertices, a.tetrahedron) < std::tie(b.vertices, b.tetrahedron);
    });
    require_two_sides(uses);
    return uses;
}

TriangleMesh boundary(const TetrahedralMesh& mesh) {
    std::vector<FaceUse> outer;
    const std::vector<FaceUse> uses = sorted_face_uses(mesh);
    for (std::size_t i = 0; i < uses.size(); ++i)
        if (i + 1 < uses.size() && uses[i + 1].vertices == uses[i].vertices)
            ++i; // the face belongs to two tetrahedra
        else
            outer.push_back(uses[i]);
    std::sort(outer.begin(), outer.end(), [](const FaceUse& a, const FaceUse& b) {
        return std::tie(a.tetrahedron, a.corner) < std::tie(b.tetrahedron, b.corner);
    });

    TriangleMesh result{mesh.vertices, {}, mesh.origin};
    result.faces.reserve(outer.size());
    for (const FaceUse& use : outer)
        result.faces.push_back(face_opposite(mesh.tetrahedra[use.tetrahedron], use.corner));
    return result;
}

} // namespace echinus
