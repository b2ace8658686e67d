#include "render/corner_normals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace echinus {

namespace {

/// The corners that meet at each vertex: corner 3 * face + k in [offsets[v], offsets[v + 1]).
struct CornersOfVertices {
    std::vector<std::uint32_t> offsets;
    std::vector<std::uint32_t> corners;

    explicit CornersOfVertices(const TriangleMesh& mesh)
        : offsets(mesh.vertices.size() + 1), corners(3 * mesh.faces.size()) {
        for (const Triangle& face : mesh.faces) {
            for (std::uint32_t vertex : face) ++offsets[vertex + 1];
        }
        for (std::size_t v = 1; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
        std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
        for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
            corners[next[mesh.faces[corner / 3][corner % 3]]++] = corner;
        }
    }

    std::span<const std::uint32_t> at(std::uint32_t vertex) const {
        return {corners.data() + offsets[vertex], corners.data() + offsets[vertex + 1]};
    }
};

Vec3d unit_or_zero(const Vec3d& v) {
    const double size = length(v);
    return size > 0 ? v * (1 / size) : Vec3d{};
}

/// A face's normal times its angle at a corner.
Vec3d weighted_normal(const TriangleMesh& mesh, const Vec3d& normal, std::uint32_t corner) {
    const Triangle& face = mesh.faces[corner / 3];
    const Vec3d apex(mesh.vertices[face[corner % 3]]);
    const Vec3d a = Vec3d(mesh.vertices[face[(corner + 1) % 3]]) - apex;
    const Vec3d b = Vec3d(mesh.vertices[face[(corner + 2) % 3]]) - apex;
    return normal * std::atan2(length(cross(a, b)), dot(a, b));
}

} // namespace

Vec3d face_normal(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    return unit_or_zero(cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a));
}

std::vector<CornerNormals> corner_normals(const TriangleMesh& mesh, double crease_angle_deg) {
    const CornersOfVertices around(mesh);
    const double cos_crease = std::cos(crease_angle_deg * std::numbers::pi / 180);
    std::vector<Vec3d> normals(mesh.faces.size());
    std::transform(mesh.faces.begin(), mesh.faces.end(), normals.begin(),
                   [&](const Triangle& face) { return face_normal(mesh, face); });
    std::vector<Vec3d> weighted(3 * mesh.faces.size());
    for (std::uint32_t corner = 0; corner < weighted.size(); ++corner) {
        weighted[corner] = weighted_normal(mesh, normals[corner / 3], corner);
    }

    std::vector<CornerNormals> result(mesh.faces.size());
    for (std::uint32_t corner = 0; corner < weighted.size(); ++corner) {
        Vec3d sum = normals[corner / 3] * 1e-6; // gives a direction even where all others cancel out
        for (std::uint32_t other : around.at(mesh.faces[corner / 3][corner % 3])) {
            if (dot(normals[other / 3], normals[corner / 3]) >= cos_crease) sum += weighted[other];
        }
        result[corner / 3][corner % 3] = Vec3f(unit_or_zero(sum));
    }
    return result;
}

} // namespace echinus
