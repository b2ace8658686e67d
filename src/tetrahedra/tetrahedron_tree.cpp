#include "tetrahedra/tetrahedron_tree.hpp"

#include "geometry/whole_numbers.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace echinus {

namespace {

double distance_sq_to_box(const FaceBox& box, const Vec3d& p) {
    const auto beyond = [](double low, double value, double high) {
        return std::max({low - value, 0.0, value - high});
    };
    const Vec3d way{beyond(box.low.x, p.x, box.high.x), beyond(box.low.y, p.y, box.high.y),
                    beyond(box.low.z, p.z, box.high.z)};
    return dot(way, way);
}

double distance_sq_to_segment(const Vec3d& a, const Vec3d& b, const Vec3d& point) {
    const Vec3d ab = b - a;
    const double share = std::clamp(dot(point - a, ab) / dot(ab, ab), 0.0, 1.0);
    const Vec3d way = point - (a + ab * share);
    return dot(way, way);
}

double distance_sq_to_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& point) {
    const Vec3d normal = cross(b - a, c - a);
    const bool projects_inside = dot(cross(b - a, point - a), normal) >= 0 &&
                                 dot(cross(c - b, point - b), normal) >= 0 &&
                                 dot(cross(a - c, point - c), normal) >= 0;
    if (projects_inside) {
        const double height = dot(point - a, normal);
        return height * height / dot(normal, normal);
    }
    return std::min({distance_sq_to_segment(a, b, point), distance_sq_to_segment(b, c, point),
                     distance_sq_to_segment(c, a, point)});
}

double distance_sq_to_tetrahedron(const TetrahedralMesh& mesh, const Tetrahedron& tetrahedron,
                                  const Vec3d& point) {
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = true;
    for (int corner = 0; corner < 4; ++corner) {
        const Triangle face = face_opposite(tetrahedron, corner);
        const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
        if (dot(cross(b - a, c - a), point - a) <= 0) continue; // behind the face
        is_inside = false;
        least = std::min(least, distance_sq_to_triangle(a, b, c, point));
    }
    return is_inside ? 0 : least;
}

} // namespace

TetrahedronTree::TetrahedronTree(const TetrahedralMesh& mesh) : mesh_(mesh), order_(mesh.tetrahedra.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    nodes_.reserve(order_.size());
    build(0, kept_as<std::uint32_t>(order_.size()));
}

FaceBox TetrahedronTree::box_of(std::uint32_t tetrahedron) const {
    const auto corner = [&](std::size_t i) -> const Vec3f& {
        return mesh_.vertices[mesh_.tetrahedra[tetrahedron][i]];
    };
    return FaceBox::around(FaceBox::around(corner(0), corner(1), corner(2)),
                           FaceBox::around(corner(3), corner(3), corner(3)));
}

void TetrahedronTree::build(std::uint32_t begin, std::uint32_t end) {
    FaceBox box = box_of(order_[begin]);
    for (std::uint32_t i = begin + 1; i < end; ++i) box = FaceBox::around(box, box_of(order_[i]));
    const std::size_t number = nodes_.size();
    nodes_.push_back({box, begin, end, 0});
    if (end - begin <= kLeafSize) return;

    const Vec3f extent = box.high - box.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto place = [&](std::uint32_t tetrahedron) {
        double sum = 0;
        for (const std::uint32_t vertex : mesh_.tetrahedra[tetrahedron]) {
            const Vec3f& p = mesh_.vertices[vertex];
            sum += double{axis == 0 ? p.x : axis == 1 ? p.y : p.z};
        }
        return std::pair(sum, tetrahedron); // the number breaks ties, so that the tree is always the same
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
    build(begin, middle);
    nodes_[number].right = kept_as<std::uint32_t>(nodes_.size());
    build(middle, end);
}

std::uint32_t TetrahedronTree::nearest(const Vec3d& point) const {
    Nearest nearest{std::numeric_limits<double>::infinity(), std::numeric_limits<std::uint32_t>::max()};
    search(0, point, nearest);
    return nearest.tetrahedron;
}

void TetrahedronTree::search(std::uint32_t number, const Vec3d& point, Nearest& nearest) const {
    const Node& node = nodes_[number];
    if (distance_sq_to_box(node.box, point) > nearest.distance_sq)
        return; // equally near ones may have smaller numbers
    if (node.end - node.begin <= kLeafSize) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const double distance_sq = distance_sq_to_tetrahedron(mesh_, mesh_.tetrahedra[order_[i]], point);
            if (std::pair(distance_sq, order_[i]) < std::pair(nearest.distance_sq, nearest.tetrahedron))
                nearest = {distance_sq, order_[i]};
        }
        return;
    }
    const bool right_first =
        distance_sq_to_box(nodes_[node.right].box, point) < distance_sq_to_box(nodes_[number + 1].box, point);
    search(right_first ? node.right : number + 1, point, nearest);
    search(right_first ? number + 1 : node.right, point, nearest);
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
