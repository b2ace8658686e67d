#include "mesh/require_valid.hpp"

#include <echinus/error.hpp>

#include <string>

namespace echinus {

namespace {

[[noreturn]] void fail_at(std::size_t face, const std::string& what) {
    throw Error(ErrorCode::InvalidMesh, "face " + std::to_string(face) + " of the mesh " + what);
}

} // namespace

void require_vertices_exist(const TriangleMesh& mesh, std::size_t face) {
    for (std::uint32_t vertex : mesh.faces[face])
        if (vertex >= mesh.vertices.size())
            fail_at(face, "refers to vertex " + std::to_string(vertex) + ", but the mesh has only " +
                              std::to_string(mesh.vertices.size()) + " vertices, numbered from 0");
}

void require_numberable(std::size_t face_count, std::size_t vertex_count) {
    const auto require = [](std::size_t count, std::size_t most, const char* what) {
        if (count > most)
            throw Error(ErrorCode::InvalidMesh, "the mesh has " + std::to_string(count) + what +
                                                    std::to_string(most) +
                                                    " that can be numbered; take it apart");
    };
    require(face_count, kMostFaces, " faces, more than the ");
    require(vertex_count, 3 * kMostFaces, " vertices, more than the ");
}

void require_valid(const TriangleMesh& mesh) {
    require_numberable(mesh.faces.size(), mesh.vertices.size());
    if (mesh.faces.empty()) throw Error(ErrorCode::InvalidMesh, "the mesh has no faces");
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        require_vertices_exist(mesh, face);
        for (std::uint32_t vertex : mesh.faces[face])
            if (!is_finite(mesh.vertices[vertex]))
                fail_at(face, "uses vertex " + std::to_string(vertex) + ", whose position is not finite");
    }
}

} // namespace echinus
