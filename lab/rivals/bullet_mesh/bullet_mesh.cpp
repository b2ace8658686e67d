#include "rivals/bullet_mesh/bullet_mesh.hpp"

#include "rivals/common/closed_mesh.hpp"

#include <echinus/error.hpp>

#include <BulletCollision/CollisionShapes/btOptimizedBvh.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace echinus::rivals {

namespace {

/// Not along an axis, where meshes often have edges; longer than the unit sphere's diameter.
const btVector3 kRay(0.9F, 1.5F, 2.43F);

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

/// The contact of the sphere and the mesh that lies nearest to the sphere's centre.
struct DeepestContact : btCollisionWorld::ContactResultCallback {
    const btCollisionObject* mesh;
    btScalar distance = std::numeric_limits<btScalar>::infinity(); ///< of the sphere's surface, negative
    btVector3 place{0, 0, 0};                                      ///< on the mesh
    std::uint32_t face = kNoIndex;

    explicit DeepestContact(const btCollisionObject& mesh_) : mesh(&mesh_) {}

    btScalar addSingleResult(btManifoldPoint& found, const btCollisionObjectWrapper* first, int, int face_a,
                             const btCollisionObjectWrapper*, int, int face_b) override {
        if (found.getDistance() >= distance) return 0;
        distance = found.getDistance();
        const bool mesh_is_first = first->getCollisionObject() == mesh;
        place = mesh_is_first ? found.getPositionWorldOnA() : found.getPositionWorldOnB();
        face = static_cast<std::uint32_t>(mesh_is_first ? face_a : face_b);
        return 0;
    }
};

/// A world in which one sphere meets one mesh. Bullet writes into it while it answers, so each batch has its
/// own, with pools that are as small as that.
class SphereAndMesh {
  public:
    SphereAndMesh(btCollisionShape& mesh_shape, btScalar reach)
        : configuration_(small_pools()), dispatcher_(&configuration_),
          world_(&dispatcher_, &broad_phase_, &configuration_), sphere_shape_(reach) {
        mesh_.setCollisionShape(&mesh_shape);
        sphere_.setCollisionShape(&sphere_shape_);
    }

    DeepestContact deepest_contact(const btVector3& place) {
        sphere_.setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
        DeepestContact deepest(mesh_);
        world_.contactPairTest(&sphere_, &mesh_, deepest);
        return deepest;
    }

  private:
    static btDefaultCollisionConstructionInfo small_pools() {
        btDefaultCollisionConstructionInfo info;
        info.m_defaultMaxPersistentManifoldPoolSize = 16;
        info.m_defaultMaxCollisionAlgorithmPoolSize = 16;
        return info;
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btDbvtBroadphase broad_phase_;
    btCollisionWorld world_;
    btSphereShape sphere_shape_;
    btCollisionObject mesh_, sphere_;
};

} // namespace

/// The mesh in a frame of its own, with the centre at the origin and radius 1: Bullet's tolerances are
/// lengths, made for meshes of about that size.
struct BulletMesh::Shape {
    Vec3d centre;
    double radius;
    btScalar reach; ///< in radii
    std::vector<Vec3f> vertices;
    std::vector<Triangle> faces;
    btTriangleIndexVertexArray arrays; ///< refers to both
    /// Not const, since Bullet's query functions are not.
    mutable btBvhTriangleMeshShape shape;

    Shape(const TriangleMesh& mesh, const Sphere& sphere, double reach_)
        : centre(sphere.centre), radius(sphere.radius), reach(static_cast<btScalar>(reach_)),
          vertices(mesh.vertices), faces(mesh.faces),
          arrays(static_cast<int>(faces.size()), reinterpret_cast<int*>(faces.data()), sizeof(Triangle),
                 static_cast<int>(vertices.size()), reinterpret_cast<btScalar*>(in_unit_sphere().data()),
                 sizeof(Vec3f)),
          shape(&arrays, true) {}
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;

    btVector3 to_shape(const Vec3f& point) const {
        const Vec3d place = (Vec3d(point) - centre) * (1 / radius);
        return {static_cast<btScalar>(place.x), static_cast<btScalar>(place.y),
                static_cast<btScalar>(place.z)};
    }
    Vec3f from_shape(const btVector3& place) const {
        return Vec3f(Vec3d(place.x(), place.y(), place.z()) * radius + centre);
    }

    /// Beyond the unit sphere there is nothing, and from there the ray might be too short. Nor is NaN asked.
    bool contains(const btVector3& place) const {
        if (!(place.length2() <= kFarthestSq)) return false;
        FirstFacing callback(place, place + kRay);
        shape.performRaycast(&callback, place, place + kRay);
        return callback.from_behind;
    }

  private:
    static constexpr btScalar kFarthestSq = 1.01F;

    std::vector<Vec3f>& in_unit_sphere() {
        for (Vec3f& vertex : vertices) vertex = Vec3f((Vec3d(vertex) - centre) * (1 / radius));
        return vertices;
    }
};

BulletMesh BulletMesh::build(const TriangleMesh& mesh, double reach) {
    require_closed(mesh, "a ray that tells sides");
    if (mesh.faces.size() > kMaxFaces)
        throw Error(ErrorCode::InvalidMesh, "the mesh has " + std::to_string(mesh.faces.size()) +
                                                " faces; Bullet's compressed tree takes " +
                                                std::to_string(kMaxFaces));
    if (!(reach >= 1e-3 && reach <= 2))
        throw Error(ErrorCode::InvalidOptions,
                    "the reach is to lie in [0.001, 2] bounding radii; it is " + std::to_string(reach));
    return BulletMesh(std::make_unique<const Shape>(mesh, inspect(mesh).bounding_sphere, reach));
}

BulletMesh::BulletMesh(std::unique_ptr<const Shape> shape) : shape_(std::move(shape)) {}
BulletMesh::BulletMesh(BulletMesh&&) noexcept = default;
BulletMesh& BulletMesh::operator=(BulletMesh&&) noexcept = default;
BulletMesh::~BulletMesh() = default;

std::size_t BulletMesh::byte_count() const {
    return shape_->shape.getOptimizedBvh()->calculateSerializeBufferSize() +
           std::span(shape_->vertices).size_bytes() + std::span(shape_->faces).size_bytes();
}

void BulletMesh::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const {
    for (std::size_t i = 0; i < points.size(); ++i)
        inside[i] = shape_->contains(shape_->to_shape(points[i])) ? 1 : 0;
}

void BulletMesh::contacts_batch(std::span<const Vec3f> points, float margin,
                                std::span<Contact> contacts) const {
    SphereAndMesh meeting(shape_->shape, shape_->reach);
    // A sphere without a radius would meet nothing, and one beyond the mesh's diameter everything.
    const double margin_in_radii = std::clamp(margin / shape_->radius, 1e-6, 4.0);
    SphereAndMesh near_meeting(shape_->shape, static_cast<btScalar>(margin_in_radii));
    for (std::size_t i = 0; i < points.size(); ++i) {
        Contact& contact = contacts[i] = no_contact(points[i]);
        const btVector3 place = shape_->to_shape(points[i]);
        contact.inside = shape_->contains(place);
        if (!contact.inside && !(margin > 0 && is_finite(points[i]))) continue;
        const DeepestContact deepest = (contact.inside ? meeting : near_meeting).deepest_contact(place);
        if (deepest.face == kNoIndex) continue; // beyond the reach
        const Vec3f on_surface = shape_->from_shape(deepest.place);
        const Vec3f out = contact.inside ? on_surface - points[i] : points[i] - on_surface;
        const float distance = length(out);
        if (!contact.inside && !(distance > 0 && distance <= margin)) continue;
        contact.point = on_surface;
        contact.face = deepest.face;
        contact.depth = contact.inside ? distance : -distance;
        if (distance > 0) contact.normal = out * (1 / distance);
    }
}

} // namespace echinus::rivals
