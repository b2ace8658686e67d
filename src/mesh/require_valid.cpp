#include "mesh/require_valid.hpp"

#include <echinus/error.hpp>

#include <algorithm>
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
                                                    " that can be numbered; divide it");
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

UsedVertices::UsedVertices(std::span<const Triangle> faces, std::size_t vertex_count)
    : is_used_(vertex_count) {
    std::uint32_t last = 0;
    for (const Triangle& face : faces) last = std::max(last, std::max(std::max(face[0], face[1]), face[2]));
    in_range_ = faces.empty() || last < vertex_count;
    if (!in_range_) return;
    for (const Triangle& face : faces)
        for (std::uint32_t vertex : face) is_used_[vertex] = 1;
    all_used_ = std::find(is_used_.begin(), is_used_.end(), 0) == is_used_.end();
}

void UsedVertices::require_valid(std::span<const Vec3f> vertices, std::span<const Triangle> faces) const {
    bool valid = in_range_ && !faces.empty();
    if (valid)
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            // The difference is NaN, which equals nothing, if a coordinate is not finite. No branch is
            // needed.
            const Vec3f difference = vertices[i] - vertices[i];
            valid &= is_used_[i] == 0 || difference == Vec3f{};
        }
    if (!valid) echinus::require_valid({{vertices.begin(), vertices.end()}, {faces.begin(), faces.end()}});
}

std::span<const Vec3f> UsedVertices::positions(std::span<const Vec3f> vertices,
                                               std::vector<Vec3f>& memory) const {
    if (all_used_) return vertices;
    memory.clear();
    for (std::size_t vertex = 0; vertex < is_used_.size(); ++vertex)
        if (is_used_[vertex] != 0) memory.push_back(vertices[vertex]);
    return memory;
}

std::vector<Vec3f> used_positions(const TriangleMesh& mesh) {
    std::vector<Vec3f> memory;
    const std::span<const Vec3f> positions =
        UsedVertices(mesh.faces, mesh.vertices.size()).positions(mesh.vertices, memory);
    return {positions.begin(), positions.end()};
}

} // namespace echinus
