#include "tetrahedra/tetrahedron_tree.hpp"

#include "geometry/triangle.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace echinus {

namespace {

double distance_to_tetrahedron(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron,
                               const Vec3d& point) {
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = true;
    for (int corner = 0; corner < 4; ++corner) {
        const Triangle face = face_opposite(tetrahedron, corner);
        const auto corner_from_point = [&](std::size_t k) { return Vec3d(mesh.vertices[face[k]]) - point; };
        const TriangleCorners corners{corner_from_point(0), corner_from_point(1), corner_from_point(2)};
        const auto& [a, b, c] = corners;
        if (dot(cross(b - a, c - a), a) >= 0) continue; // behind the face
        is_inside = false;
        least = std::min(least, nearest_on_triangle(corners).distance);
    }
    return is_inside ? 0 : least;
}

std::vector<BoxTree::Box> boxes_of(const TetrahedralMesh& mesh) {
    std::vector<BoxTree::Box> boxes(mesh.tetrahedra.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (const std::uint32_t vertex : mesh.tetrahedra[i]) boxes[i].add(mesh.vertices[vertex]);
    return boxes;
}

} // namespace

TetrahedronTree::TetrahedronTree(const TetrahedralMesh& mesh) : mesh_(mesh), tree_(boxes_of(mesh)) {}

std::uint32_t TetrahedronTree::nearest(const Vec3d& point) const {
    Nearest nearest{std::numeric_limits<double>::infinity(), std::numeric_limits<std::uint32_t>::max()};
    search(0, point, nearest);
    return nearest.tetrahedron;
}

void TetrahedronTree::search(std::uint32_t number, const Vec3d& point, Nearest& nearest) const {
    const BoxTree::Node& node = tree_.node(number);
    if (node.box.distance(point) > nearest.distance) return; // equally near ones may have smaller numbers
    if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const std::uint32_t tetrahedron = tree_.leaf(i).item;
            const double distance = distance_to_tetrahedron(mesh_, mesh_.tetrahedra[tetrahedron], point);
            if (std::pair(distance, tetrahedron) < std::pair(nearest.distance, nearest.tetrahedron))
                nearest = {distance, tetrahedron};
        }
        return;
    }
    const std::uint32_t left = number + 1;
    const bool right_first =
        tree_.node(node.right).box.distance(point) < tree_.node(left).box.distance(point);
    search(right_first ? node.right : left, point, nearest);
    search(right_first ? left : node.right, point, nearest);
}

std::array<double, 4> weights_of(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron,
                                 const Vec3d& point) {
    std::array<double, 4> volumes{};
    double sum = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const Triangle face = face_opposite(tetrahedron, corner);
        const Vec3d a(mesh.vertices[face[0]]);
        const Vec3d normal = cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a);
        volumes[static_cast<std::size_t>(corner)] = dot(normal, a - point);
        sum += volumes[static_cast<std::size_t>(corner)];
    }
    for (double& volume : volumes) volume /= sum;
    return volumes;
}

} // namespace echinus
