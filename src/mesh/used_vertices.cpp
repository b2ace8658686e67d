#include "mesh/used_vertices.hpp"

#include <algorithm>

namespace echinus {

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
            // A coordinate that is not finite gives NaN, which equals nothing. No branch is needed.
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
