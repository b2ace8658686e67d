#include "rivals/bullet.hpp"

#include "common/heap.hpp"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

using namespace echinus;

namespace {

/// The facing of the nearest face: Bullet turns the normal it reports to the ray, so the face's own is taken
/// from its corners, as processTriangle() is given them.
struct FirstFacing : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;

    void processTriangle(btVector3* corners, int part, int index) override {
        const btVector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        from_behind_if_nearest = normal.dot(m_to - m_from) > 0;
        btTriangleRaycastCallback::processTriangle(corners, part, index);
    }
    btScalar reportHit(const btVector3&, btScalar fraction, int, int) override {
        from_behind = from_behind_if_nearest;
        return fraction;
    }

    bool from_behind_if_nearest = false, from_behind = false;
};

} // namespace

struct BulletRival::Impl {
    std::size_t heap_before = heap_bytes();
    btTriangleIndexVertexArray arrays;
    btBvhTriangleMeshShape shape;
    std::size_t bytes;
    btVector3 ray; ///< longer than the mesh

    explicit Impl(const TriangleMesh& mesh)
        : arrays(static_cast<int>(mesh.faces.size()),
                 reinterpret_cast<int*>(const_cast<Triangle*>(mesh.faces.data())), sizeof(Triangle),
                 static_cast<int>(mesh.vertices.size()),
                 reinterpret_cast<btScalar*>(const_cast<Vec3f*>(mesh.vertices.data())), sizeof(Vec3f)),
          shape(&arrays, true), bytes(heap_bytes() - heap_before + mesh.faces.size() * sizeof(Triangle) +
                                      mesh.vertices.size() * sizeof(Vec3f)) {
        const auto radius = static_cast<float>(inspect(mesh).bounding_sphere.radius);
        ray = btVector3(0.3F, 0.5F, 0.81F) * (3 * radius);
    }
};

BulletRival::BulletRival(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}

BulletRival::~BulletRival() = default;

bool BulletRival::inside(const Vec3f& point) const {
    const btVector3 from(point.x, point.y, point.z);
    FirstFacing callback(from, from + impl_->ray);
    impl_->shape.performRaycast(&callback, from, from + impl_->ray);
    return callback.from_behind;
}

std::size_t BulletRival::byte_count() const {
    return impl_->bytes;
}
