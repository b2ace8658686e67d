#include "geometry/box_tree.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"
#include "geometry/triangle.hpp"
#include "tetrahedra/tetrahedron_faces.hpp"

#include <echinus/error.hpp>
#include <echinus/tetrahedra.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// The tetrahedra of a body in a tree of boxes.
class TetrahedronTree {
  public:
    /// @param mesh  valid, with at least one tetrahedron; must outlive the tree
    explicit TetrahedronTree(const TetrahedralMesh& mesh);

    /// The tetrahedron that contains the point or, if there is none, the nearest one; of several, the one
    /// with the smallest number.
    std::uint32_t nearest(const Vec3d& point) const;

  private:
    struct Nearest {
        double distance;
        std::uint32_t tetrahedron;
    };

    void search(std::uint32_t node, const Vec3d& point, Nearest& nearest) const;

    const TetrahedralMesh& mesh_;
    BoxTree tree_;
};

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

TetrahedronTree::TetrahedronTree(const TetrahedralMesh& mesh) : mesh_(mesh), tree_(boxes_of(mesh)) {
    tree_.split_all();
}

std::uint32_t TetrahedronTree::nearest(const Vec3d& point) const {
    Nearest nearest{std::numeric_limits<double>::infinity(), std::numeric_limits<std::uint32_t>::max()};
    search(0, point, nearest);
    return nearest.tetrahedron;
}

void TetrahedronTree::search(std::uint32_t number, const Vec3d& point, Nearest& nearest) const {
    const BoxTree::Node& node = tree_.node(number);
    if (node.box.distance(point) > nearest.distance) return; // an equal one may have a smaller number
    if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const std::uint32_t tetrahedron = tree_.leaf(i).item;
            const double distance = distance_to_tetrahedron(mesh_, mesh_.tetrahedra[tetrahedron], point);
            if (std::pair(distance, tetrahedron) < std::pair(nearest.distance, nearest.tetrahedron))
                nearest = {distance, tetrahedron};
        }
        return;
    }
    const bool right_first =
        tree_.node(node.right()).box.distance(point) < tree_.node(node.left).box.distance(point);
    search(right_first ? node.right() : node.left, point, nearest);
    search(right_first ? node.left : node.right(), point, nearest);
}

/// The point's weights: the volumes of the tetrahedra that it forms with the faces, as fractions of their
/// sum.
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

} // namespace

Embedding embed(const TetrahedralMesh& mesh, StridedSpan<const Vec3f> points, unsigned thread_count) {
    require_valid_tetrahedra(mesh);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            throw Error(ErrorCode::InvalidMesh,
                        "point " + std::to_string(i) + " to be embedded is not finite");
    const TetrahedronTree tree(mesh);
    Embedding embedding(points.size());
    parallel_for(points.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            EmbeddedPoint& result = embedding[i];
            result.tetrahedron = tree.nearest(Vec3d(points[i]));
            result.vertices = mesh.tetrahedra[result.tetrahedron];
            const auto weights = weights_of(mesh, result.vertices, Vec3d(points[i]));
            for (std::size_t k = 0; k < 4; ++k) result.weights[k] = static_cast<float>(weights[k]);
        }
    });
    return embedding;
}

void carry(const Embedding& embedding, StridedSpan<const Vec3f> positions, StridedSpan<Vec3f> points,
           unsigned thread_count) noexcept {
    if (!is_met(points.size() == embedding.size(),
                "carry: the number of points differs from the number that was embedded"))
        return;
    for_each_piece(embedding.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Tetrahedron& corners = embedding[i].vertices;
            // Summed relative to the first corner, so that a translation is not scaled if rounding makes the
            // sum of weights differ from 1.
            const Vec3d first(positions[corners[0]]);
            Vec3d point = first;
            for (std::size_t k = 1; k < 4; ++k)
                point += (Vec3d(positions[corners[k]]) - first) * double{embedding[i].weights[k]};
            points[i] = Vec3f(point);
        }
    });
}

} // namespace echinus
