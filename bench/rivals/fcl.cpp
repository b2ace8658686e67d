#include "rivals/fcl.hpp"

#include "common/heap.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>

using namespace echinus;

struct FclRival::Impl {
    using Tree = fcl::BVHModel<fcl::OBBRSSf>;

    std::size_t heap_before = heap_bytes();
    const TriangleMesh& mesh;
    std::shared_ptr<Tree> tree = std::make_shared<Tree>();
    fcl::CollisionObjectf object{tree};
    std::shared_ptr<fcl::Spheref> particle;
    std::size_t bytes;

    explicit Impl(const TriangleMesh& mesh_)
        : mesh(mesh_), particle(std::make_shared<fcl::Spheref>(
                           static_cast<float>(1e-6 * inspect(mesh_).bounding_sphere.radius))) {
        std::vector<fcl::Vector3f> vertices;
        for (const Vec3f& v : mesh.vertices) vertices.emplace_back(v.x, v.y, v.z);
        std::vector<fcl::Triangle> faces;
        for (const Triangle& face : mesh.faces) faces.emplace_back(face[0], face[1], face[2]);
        tree->beginModel(static_cast<int>(faces.size()), static_cast<int>(vertices.size()));
        tree->addSubModel(vertices, faces);
        tree->endModel();
        bytes = heap_bytes() - heap_before - vertices.capacity() * sizeof(fcl::Vector3f) -
                faces.capacity() * sizeof(fcl::Triangle);
    }
};

FclRival::FclRival(const TriangleMesh& mesh) : impl_(std::make_unique<const Impl>(mesh)) {}

FclRival::~FclRival() = default;

DepthNormal FclRival::contact(const Vec3f& point) const {
    fcl::CollisionObjectf sphere(impl_->particle,
                                 fcl::Transform3f(fcl::Translation3f(point.x, point.y, point.z)));
    fcl::DistanceRequestf request(true);
    fcl::DistanceResultf result;
    fcl::distance(&impl_->object, &sphere, request, result);
    if (result.b1 < 0) return {};
    const Triangle& face = impl_->mesh.faces[static_cast<std::size_t>(result.b1)];
    const auto& vertices = impl_->mesh.vertices;
    const Vec3f normal = cross(vertices[face[1]] - vertices[face[0]], vertices[face[2]] - vertices[face[0]]);
    if (dot(normal, point - vertices[face[0]]) >= 0) return {};
    const float distance = std::max(result.min_distance, 0.0F) + impl_->particle->radius;
    return {distance, normal * (1 / length(normal))};
}

std::size_t FclRival::byte_count() const {
    return impl_->bytes;
}
