#include "rivals/unshipped/triangle_rivals.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>

namespace echinus::rivals {

namespace {

using Tree = fcl::BVHModel<fcl::OBBRSSf>;

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
