#include "mesh/used_vertices.hpp"

namespace echinus {

std::vector<bool> is_vertex_used(const TriangleMesh& mesh) {
    std::vector<bool> is_used(mesh.vertices.size());
    for (const Triangle& face : mesh.faces)
        for (std::uint32_t vertex : face) is_used[vertex] = true;
    return is_used;
}

std::vector<Vec3f> used_positions(const TriangleMesh& mesh) {
    const std::vector<bool> is_used = is_vertex_used(mesh);
    std::vector<Vec3f> positions;
    for (std::size_t vertex = 0; vertex < is_used.size(); ++vertex)
        if (is_used[vertex]) positions.push_back(mesh.vertices[vertex]);
    return positions;
}

} // namespace echinus
