#include "mesh/faces.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <numeric>

namespace echinus {

namespace {

Triangle sorted(Triangle face) {
    std::sort(face.begin(), face.end());
    return face;
}

bool is_degenerate(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    return has_equal_corners(face) ||
           cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a) == Vec3d{};
}

} // namespace

bool has_equal_corners(const Triangle& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

double six_volumes(const TriangleMesh& mesh, const Triangle& face, const Vec3d& reference) {
    return dot(Vec3d(mesh.vertices[face[0]]) - reference,
               cross(Vec3d(mesh.vertices[face[1]]) - reference, Vec3d(mesh.vertices[face[2]]) - reference));
}

std::vector<std::vector<std::uint32_t>> find_equal_faces(const TriangleMesh& mesh) {
    std::vector<Triangle> keys;
    keys.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces) keys.push_back(sorted(face));
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    std::vector<std::vector<std::uint32_t>> groups;
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (keys[order[i]] != keys[order[i - 1]]) continue;
        const bool is_second = i == 1 || keys[order[i]] != keys[order[i - 2]];
        if (is_second) groups.push_back({order[i - 1]});
        groups.back().push_back(order[i]);
    }
    return groups;
}

std::vector<std::uint32_t> find_duplicate_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> duplicates;
    for (const std::vector<std::uint32_t>& group : find_equal_faces(mesh))
        duplicates.insert(duplicates.end(), group.begin() + 1, group.end());
    std::sort(duplicates.begin(), duplicates.end());
    return duplicates;
}

std::vector<std::uint32_t> find_degenerate_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> degenerate;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        if (is_degenerate(mesh, mesh.faces[face])) degenerate.push_back(kept_as<std::uint32_t>(face));
    return degenerate;
}

} // namespace echinus
