#include "rivals/common/closed_mesh.hpp"
#include "rivals/unshipped/unshipped.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <vector>

namespace echinus::rivals {

namespace {

using Tree = fcl::BVHModel<fcl::OBBRSSf>;

class FclTree final : public System {
  public:
    explicit FclTree(const TriangleMesh& mesh)
        : mesh_(mesh), sphere_(std::make_shared<fcl::Spheref>(
                           static_cast<float>(1e-6 * inspect(mesh).bounding_sphere.radius))) {
        const std::size_t heap_before = heap_bytes();
        std::vector<fcl::Vector3f> vertices;
        for (const Vec3f& v : mesh.vertices) vertices.emplace_back(v.x, v.y, v.z);
        std::vector<fcl::Triangle> faces;
        for (const Triangle& face : mesh.faces) faces.emplace_back(face[0], face[1], face[2]);
        tree_->beginModel(static_cast<int>(faces.size()), static_cast<int>(vertices.size()));
        tree_->addSubModel(vertices, faces);
        tree_->endModel();
        bytes_ = heap_bytes() - heap_before - vertices.capacity() * sizeof(fcl::Vector3f) -
                 faces.capacity() * sizeof(fcl::Triangle);
    }

    std::string name() const override { return "fcl"; }
    std::size_t byte_count() const override { return bytes_; }
    std::string_view counted() const override { return "what the construction took from the heap"; }

    Contact contact(const Vec3f& point, float /*margin*/) const override {
        if (!is_finite(point)) return no_contact(point);
        fcl::CollisionObjectf sphere(sphere_,
                                     fcl::Transform3f(fcl::Translation3f(point.x, point.y, point.z)));
        fcl::DistanceRequestf request(true);
        fcl::DistanceResultf result;
        fcl::distance(&object_, &sphere, request, result);
        if (result.b1 < 0) return no_contact(point);
        const auto& [a, b, c] = mesh_.faces[static_cast<std::size_t>(result.b1)];
        const Vec3f normal =
            cross(mesh_.vertices[b] - mesh_.vertices[a], mesh_.vertices[c] - mesh_.vertices[a]);
        if (dot(normal, point - mesh_.vertices[a]) >= 0) return no_contact(point);
        const float depth = std::max(result.min_distance, 0.0F) + sphere_->radius;
        return contact_along(point, depth, normal * (1 / length(normal)));
    }

    void contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const override {
        for (std::size_t i = 0; i < points.size(); ++i) inside[i] = contact(points[i], 0).inside;
    }
    void contacts_batch(std::span<const Vec3f> points, float margin,
                        std::span<Contact> contacts) const override {
        for (std::size_t i = 0; i < points.size(); ++i) contacts[i] = contact(points[i], margin);
    }
    using System::contacts_batch;

  private:
    TriangleMesh mesh_;
    std::shared_ptr<Tree> tree_ = std::make_shared<Tree>();
    fcl::CollisionObjectf object_{tree_};
    std::shared_ptr<fcl::Spheref> sphere_;
    std::size_t bytes_ = 0;
};

} // namespace

std::unique_ptr<const System> fcl_tree(const TriangleMesh& mesh) {
    require_closed(mesh, "the side of the nearest face");
    return std::make_unique<const FclTree>(mesh);
}

namespace {

std::shared_ptr<Tree> tree_of(const TriangleMesh& mesh) {
    std::vector<fcl::Vector3f> vertices;
    for (const Vec3f& v : mesh.vertices) vertices.emplace_back(v.x, v.y, v.z);
    std::vector<fcl::Triangle> faces;
    for (const Triangle& face : mesh.faces) faces.emplace_back(face[0], face[1], face[2]);
    auto tree = std::make_shared<Tree>();
    tree->beginModel(static_cast<int>(faces.size()), static_cast<int>(vertices.size()));
    tree->addSubModel(vertices, faces);
    tree->endModel();
    return tree;
}

class FclTriangles final : public TriangleRival {
  public:
    explicit FclTriangles(const TriangleMesh& model) : model_(tree_of(model)) {}

    void find_intersecting(const TriangleMesh& mesh, std::span<std::uint8_t> meets) const override {
        constexpr std::size_t kAll = 10'000'000;
        const fcl::CollisionObjectf other(tree_of(mesh));
        fcl::CollisionResultf result;
        fcl::collide(&model_, &other, fcl::CollisionRequestf(kAll), result);
        std::fill(meets.begin(), meets.end(), std::uint8_t{0});
        for (std::size_t i = 0; i < result.numContacts(); ++i)
            meets[static_cast<std::size_t>(result.getContact(i).b2)] = 1;
    }

  private:
    fcl::CollisionObjectf model_;
};

} // namespace

std::unique_ptr<const TriangleRival> fcl_triangles(const TriangleMesh& model) {
    return std::make_unique<const FclTriangles>(model);
}

} // namespace echinus::rivals
