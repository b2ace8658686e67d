#pragma once

#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/particle_collision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletSoftBody/btDefaultSoftBodySolver.h>
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyConcaveCollisionAlgorithm.h>
#include <LinearMath/btAabbUtil2.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

/// Lets Bullet's soft bodies collide with exact maps, without a change of Bullet (docs/bullet.md): a MapShape
/// replaces a mesh shape, and a Solver replaces Bullet's own.
///
/// This is a header-only library for Bullet 3.24. Bullet may be built with floats, or with doubles for large
/// worlds: then positions are rounded to float only in the frame of each shape.
namespace echinus::bullet {

// ---- Bullet's numbers

inline Vec3d to_echinus(const btVector3& v) {
    return {double{v.x()}, double{v.y()}, double{v.z()}};
}
template <typename T>
btVector3 to_bullet(const Vec3<T>& v) {
    return {btScalar(v.x), btScalar(v.y), btScalar(v.z)};
}
inline RigidTransform to_echinus(const btTransform& pose) {
    const btQuaternion q = pose.getRotation();
    const Rotation rotation{double{q.w()}, double{q.x()}, double{q.y()}, double{q.z()}};
    return {rotation.normalised(), to_echinus(pose.getOrigin())};
}

inline bool is_finite(const btTransform& pose) {
    const auto [rotation, translation] = to_echinus(pose);
    return is_finite(translation) && std::isfinite(rotation.w + rotation.x + rotation.y + rotation.z);
}

/// Bullet itself stops bodies whose boxes extend to about this distance.
constexpr btScalar kLargestMargin = 1e5;

/// @throws Error InvalidOptions unless the margin is from 0 to kLargestMargin
inline void check_margin(btScalar margin, const char* owner) {
    if (margin >= 0 && margin <= kLargestMargin) return;
    throw Error(ErrorCode::InvalidOptions, std::string("the margin of ") + owner + " is " +
                                               std::to_string(margin) + "; expected 0 to 1e5");
}

[[noreturn]] inline void throw_no_solver() {
    throw Error(
        ErrorCode::InvalidOptions,
        "a soft body meets a MapShape in a world that was not given an echinus::bullet::Solver for its "
        "dispatcher, and would fall through; give it to btSoftRigidDynamicsWorld as the last argument");
}

/// An axis-aligned box; empty until points are added.
struct Box {
    btVector3 low{SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY};
    btVector3 high{-SIMD_INFINITY, -SIMD_INFINITY, -SIMD_INFINITY};

    /// Ignores NaN.
    void add(const btVector3& point) {
        for (int i = 0; i < 3; ++i) {
            low[i] = btMin(point[i], low[i]);
            high[i] = btMax(point[i], high[i]);
        }
    }
    /// The box around this one in the frame of a pose. The origin is subtracted first, so that floats lose
    /// nothing far from 0.
    Box seen_from(const btTransform& pose) const {
        const btVector3 from = low - pose.getOrigin(), to = high - pose.getOrigin();
        const btVector3 centre = (from + to) / 2 * pose.getBasis();
        const btVector3 reach = (to - from) / 2 * pose.getBasis().absolute();
        return {centre - reach, centre + reach};
    }
    /// A box with NaN intersects every box.
    bool meets(const Box& other) const { return TestAabbAgainstAabb2(low, high, other.low, other.high); }
};

/// A closed surface as a Bullet shape, for static, kinematic and dynamic objects and as a child of compounds.
/// Soft bodies collide with it in a world with a Solver. Any number of objects may share it.
///
/// The margin, 0 unless set, is added to that of the soft body. If a soft body meets the shape in a world
/// without a Solver, the step throws Error InvalidOptions.
class MapShape : public btConcaveShape {
  public:
    /// @param for_rigid_bodies the shape with which rigid bodies and rays collide instead, such as a
    /// btBvhTriangleMeshShape of the same mesh; it must outlive this shape. Null: they collide with nothing
    /// @throws Error InvalidMesh for the map of an open surface, and for one with an origin
    explicit MapShape(ExactMap map, const btConcaveShape* for_rigid_bodies = nullptr)
        : collider_{.map = std::move(map)}, for_rigid_bodies_(for_rigid_bodies) {
        if (!this->map().view().border.empty())
            throw Error(ErrorCode::InvalidMesh,
                        "the surface is open, so what is inside is not certain; close it with repair()");
        if (this->map().view().origin != Vec3d{})
            throw Error(ErrorCode::InvalidMesh, "the mesh is too far from 0 for a shape; move its vertices "
                                                "to 0, and the object to where they were");
        // This type is meant for foreign meshes, and no shape of Bullet has it. CUSTOM_CONCAVE_SHAPE_TYPE is
        // also the type of btSdfCollisionShape, to which Bullet casts unchecked.
        m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
    }

    const ExactMap& map() const { return std::get<ExactMap>(collider_.map.kind); }
    Collider at(const btTransform& pose) const {
        Collider placed = collider_;
        placed.pose = to_echinus(pose);
        return placed;
    }
    /// The radius of a ball that contains the scaled surface.
    btScalar radius() const {
        return btScalar(map().view().radius) * scale_.absolute()[scale_.absolute().maxAxis()];
    }

    /// A box around the scaled surface, with a margin for rounding, in the frame of the shape.
    Box local_box() const {
        const btVector3 centre = to_bullet(map().view().centre) * scale_;
        const btVector3 reach = btVector3(1, 1, 1) * radius() * btScalar(1.001);
        return {centre - reach, centre + reach};
    }

    /// The box of the bounding sphere.
    void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override {
        const btVector3 centre = pose(to_bullet(map().view().centre) * scale_);
        const btScalar reach = radius() + getMargin();
        low = centre - btVector3(reach, reach, reach);
        high = centre + btVector3(reach, reach, reach);
    }
    /// @throws Error InvalidOptions when Bullet asks for a soft body
    void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                             const btVector3& high) const override {
        if (dynamic_cast<btSoftBodyTriangleCallback*>(callback) != nullptr) throw_no_solver();
        if (for_rigid_bodies_ != nullptr) for_rigid_bodies_->processAllTriangles(callback, low, high);
    }
    /// @throws Error InvalidOptions unless it is from 0 to kLargestMargin
    void setMargin(btScalar margin) override {
        check_margin(margin, "a MapShape");
        btConcaveShape::setMargin(margin);
    }
    /// Affects only the collider of soft bodies: set the scale of the shape for rigid bodies, too. Negative
    /// numbers mirror. @throws Error InvalidOptions for 0 or a number that is not finite
    void setLocalScaling(const btVector3& scale) override {
        const Vec3d numbers = to_echinus(scale);
        if (!is_finite(numbers) || numbers.x == 0 || numbers.y == 0 || numbers.z == 0)
            throw Error(ErrorCode::InvalidOptions, "the scale of a shape is 0 or not finite along an axis");
        scale_ = scale;
        collider_.scale = numbers;
    }
    const btVector3& getLocalScaling() const override { return scale_; }
    /// Returns the inertia of a solid ball of the bounding radius; you can give a body a better one.
    void calculateLocalInertia(btScalar mass, btVector3& inertia) const override {
        const btScalar moment = btScalar(0.4) * mass * radius() * radius();
        inertia.setValue(moment, moment, moment);
    }
    const char* getName() const override { return "ExactMap"; }

  private:
    Collider collider_;
    const btConcaveShape* for_rigid_bodies_;
    btVector3 scale_{1, 1, 1};
};

/// Returns null for another shape, including a user's shape of the same type.
inline const MapShape* as_map_shape(const btCollisionShape& shape) {
    return shape.getShapeType() == FAST_CONCAVE_MESH_PROXYTYPE ? dynamic_cast<const MapShape*>(&shape)
                                                               : nullptr;
}

/// The contacts of a soft body's nodes with some shapes. The arrays are reused in the next step.
class NodeContacts {
  public:
    void find(std::span<const Collider> colliders, const btSoftBody& body, btScalar margin) {
        const auto node_count = static_cast<std::size_t>(body.m_nodes.size());
        do {
            make_room(std::max(count_, node_count));
            count_ = contacts_into(colliders, positions_of(body), static_cast<float>(margin),
                                   {.particles = nodes_,
                                    .points = points_,
                                    .normals = normals_,
                                    .depths = depths_,
                                    .colliders = colliders_});
        } while (count_ > nodes_.size());
    }

    std::size_t count() const { return count_; }
    std::size_t collider(std::size_t k) const { return colliders_[k]; }
    int node(std::size_t k) const { return static_cast<int>(nodes_[k]); }
    btVector3 point(std::size_t k) const { return to_bullet(points_[k]); }
    btVector3 normal(std::size_t k) const { return to_bullet(normals_[k]); }
    btScalar depth(std::size_t k) const { return btScalar(depths_[k]); }

  private:
    /// The nodes' positions, read in place, whether Bullet has floats or doubles.
    static StridedSpan<const Vec3<btScalar>> positions_of(const btSoftBody& body) {
        const auto& nodes = body.m_nodes;
        const auto count = static_cast<std::size_t>(nodes.size());
        return {reinterpret_cast<const Vec3<btScalar>*>(&nodes[0].m_x), count, sizeof(btSoftBody::Node)};
    }
    void make_room(std::size_t count) {
        if (nodes_.size() >= count) return;
        for (auto* numbers : {&colliders_, &nodes_}) numbers->resize(count);
        points_.resize(count);
        normals_.resize(count);
        depths_.resize(count);
    }

    std::size_t count_ = 0;
    std::vector<std::uint32_t> colliders_, nodes_;
    std::vector<Vec3<btScalar>> points_;
    std::vector<Vec3f> normals_;
    std::vector<float> depths_;
};

/// A soft body and an object with a MapShape, which may touch in this step.
struct Meeting {
    btSoftBody* body = nullptr;
    const btCollisionObject* object = nullptr;
    const MapShape* shape = nullptr;

    btScalar margin() const { return body->getCollisionShape()->getMargin() + shape->getMargin(); }
    btScalar friction() const { return body->m_cfg.kDF * object->getFriction(); }
    /// The velocity of the object's material.
    btVector3 velocity_at(const btVector3& point) const {
        const btRigidBody* rigid = btRigidBody::upcast(object);
        if (rigid == nullptr) return {0, 0, 0};
        return rigid->getVelocityInLocalPoint(point - rigid->getCenterOfMassPosition());
    }
};

/// Whether the settings of a soft body let it meet an object with a MapShape.
inline bool wants_contact(const btSoftBody& body, const btCollisionObject& object) {
    return (body.m_cfg.collisions & btSoftBody::fCollision::RVSmask) != 0 && body.m_nodes.size() > 0 &&
           body.m_collisionDisabledObjects.findLinearSearch(&object) ==
               body.m_collisionDisabledObjects.size();
}

/// A soft body near an object with a MapShape, and their contacts. The Solver holds one for each pair that
/// the broad phase reports.
class SoftBodyPair {
  public:
    /// Bullet's collision detection has found that the two may touch in this step.
    void begin_step(btSoftBody& body, const btCollisionObjectWrapper& collider) {
        const btCollisionObject& object = *collider.getCollisionObject();
        const MapShape* shape = as_map_shape(*collider.getCollisionShape());
        if (shape == nullptr || !wants_contact(body, object)) return;
        meeting_ = {&body, &object, shape};
        in_object_ = shape == object.getCollisionShape()
                         ? btTransform::getIdentity()
                         : object.getWorldTransform().inverseTimes(collider.getWorldTransform());
    }
    void end_step() { meeting_ = {}; }

    bool is_of(const btSoftBody& body, const btCollisionObject& object) const {
        return meeting_.body == &body && meeting_.object == &object;
    }
    /// Whether the two should have contacts in this step. Contacts with a link of a multibody need Jacobians
    /// that its solver does not expose.
    bool has_contacts(const btSoftBody& body) const {
        return meeting_.body == &body &&
               meeting_.object->getInternalType() != btCollisionObject::CO_FEATHERSTONE_LINK;
    }
    Collider now() const { return meeting_.shape->at(meeting_.object->getWorldTransform() * in_object_); }
    btScalar margin() const { return meeting_.margin(); }

    /// Adds a contact for Bullet's solver, as Bullet does for its convex shapes, with the friction and the
    /// hardness that Bullet gives them.
    void add_contact(int node, const btVector3& point, const btVector3& normal) {
        add(meeting_.body->m_nodes[node], point, normal);
    }

  private:
    // Bullet 3.24 fills the members in this way for its own shapes; PSolve_RContacts() reads them.
    void add(btSoftBody::Node& node, const btVector3& point, const btVector3& normal) {
        if (node.m_battach != 0) return;
        const auto& [body, object, shape] = meeting_;
        const btRigidBody* rigid = btRigidBody::upcast(object);
        if (rigid != nullptr && rigid->isStaticOrKinematicObject()) rigid = nullptr;
        if (node.m_im == 0 && rigid == nullptr) return;
        const btScalar seconds = body->m_sst.sdt, friction = meeting_.friction();
        const btVector3 slip = node.m_x - node.m_q - meeting_.velocity_at(node.m_x) * seconds;
        const btScalar approach = slip.dot(normal);
        btSoftBody::RContact contact;
        for (btVector3* unused : {&contact.m_cti.m_bary, &contact.t1, &contact.t2}) unused->setZero();
        contact.m_cti.m_colObj = object;
        contact.m_cti.m_normal = normal;
        contact.m_cti.m_offset = -normal.dot(point) - margin();
        contact.m_node = &node;
        contact.m_c1 = node.m_x - object->getWorldTransform().getOrigin();
        contact.m_c0 = impulse_matrix(node.m_im, rigid, contact.m_c1, seconds);
        contact.m_c2 = node.m_im * seconds;
        const bool constraints =
            (slip - normal * approach).length2() < approach * approach * friction * friction;
        contact.m_c3 = constraints ? btScalar(0) : 1 - friction;
        contact.m_c4 = object->isStaticOrKinematicObject() ? body->m_cfg.kKHR : body->m_cfg.kCHR;
        body->m_rcontacts.push_back(contact);
        if (rigid != nullptr) rigid->activate();
    }

    /// The impulse that separates node and body, per unit of displacement in one step.
    static btMatrix3x3 impulse_matrix(btScalar inverse_mass, const btRigidBody* rigid, const btVector3& arm,
                                      btScalar seconds) {
        const btScalar sum = inverse_mass + (rigid != nullptr ? rigid->getInvMass() : btScalar(0));
        btMatrix3x3 mobility(sum, 0, 0, 0, sum, 0, 0, 0, sum);
        if (rigid != nullptr) {
            const btMatrix3x3 lever(0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0);
            mobility -= lever * rigid->getInvInertiaTensorWorld() * lever;
        }
        return mobility.inverse() * (1 / seconds);
    }

    Meeting meeting_;       ///< null pointers if the two do not meet in this step
    btTransform in_object_; ///< of the shape; not the identity in a compound
};

/// The boxes of a soft body's nodes at the start and at the end of the step.
struct NodeBoxes {
    Box start, end;

    explicit NodeBoxes(const btSoftBody& body) {
        for (int i = 0; i < body.m_nodes.size(); ++i) {
            start.add(body.m_nodes[i].m_q);
            end.add(body.m_nodes[i].m_x);
        }
        if (!body.isActive()) start = end; // a sleeping body does not move
    }
};

/// A MapShape of an object in the world, alone or in compounds.
struct PlacedShape {
    btCollisionObject* object;
    int object_id; ///< the number of its proxy in the broad phase
    int number;    ///< of the object's MapShapes
    const MapShape* shape;
    btVector3 scale;                 ///< of the shape
    btTransform pose, previous_pose; ///< at the end of this step and of the last one

    auto key() const { return std::tuple(object_id, number); }
    /// Bullet continues with bodies that have exploded.
    bool is_somewhere() const { return is_finite(pose) && is_finite(previous_pose); }

    /// Whether nodes may be inside now or have met the surface during the step: in the frame of the moving
    /// shape each moves straight from one box to the other.
    bool is_near(const NodeBoxes& nodes) const {
        const Box end = nodes.end.seen_from(pose);
        Box way = nodes.start.seen_from(previous_pose);
        way.low.setMin(end.low);
        way.high.setMax(end.high);
        return way.meets(shape->local_box());
    }
};

/// The MapShapes in a world, with their poses at the start of the step.
class PlacedShapes {
  public:
    /// At the end of a step.
    void update(btBroadphaseInterface& broadphase, btScalar seconds) {
        shapes_.swap(last_);
        shapes_.clear();
        Visitor visitor(*this, seconds);
        const btVector3 far(SIMD_INFINITY, SIMD_INFINITY, SIMD_INFINITY);
        broadphase.aabbTest(-far, far, visitor);
        std::ranges::sort(shapes_, {}, &PlacedShape::key);
    }
    void clear() { shapes_.clear(); }

    std::span<const PlacedShape> all() const { return shapes_; }

  private:
    struct Visitor : btBroadphaseAabbCallback {
        Visitor(PlacedShapes& shapes, btScalar seconds) : shapes_(shapes), seconds_(seconds) {}
        bool process(const btBroadphaseProxy* proxy) override {
            auto& object = *static_cast<btCollisionObject*>(proxy->m_clientObject);
            int count = 0;
            shapes_.add(object, *object.getCollisionShape(), btTransform::getIdentity(), count, seconds_);
            return true;
        }
        PlacedShapes& shapes_;
        btScalar seconds_;
    };

    void add(btCollisionObject& object, const btCollisionShape& shape, const btTransform& in_object,
             int& count, btScalar seconds) {
        if (shape.isCompound()) {
            const auto& compound = static_cast<const btCompoundShape&>(shape);
            for (int i = 0; i < compound.getNumChildShapes(); ++i)
                add(object, *compound.getChildShape(i), in_object * compound.getChildTransform(i), count,
                    seconds);
        } else if (const MapShape* map_shape = as_map_shape(shape)) {
            PlacedShape placed{.object = &object,
                               .object_id = object.getBroadphaseHandle()->getUid(),
                               .number = count++,
                               .shape = map_shape,
                               .scale = map_shape->getLocalScaling(),
                               .pose = object.getWorldTransform() * in_object,
                               .previous_pose = {}};
            const PlacedShape* last = find_last(placed);
            placed.previous_pose = last != nullptr ? last->pose : previous_pose(object, seconds) * in_object;
            shapes_.push_back(placed);
        }
    }

    const PlacedShape* find_last(const PlacedShape& shape) const {
        const auto place = std::ranges::lower_bound(last_, shape.key(), {}, &PlacedShape::key);
        const bool is_same = place != last_.end() && place->key() == shape.key() &&
                             place->object == shape.object && place->shape == shape.shape;
        return is_same ? &*place : nullptr;
    }

    /// The previous pose of an object that was not in the world at the end of the last step, extrapolated
    /// from its velocity.
    static btTransform previous_pose(const btCollisionObject& object, btScalar seconds) {
        btTransform pose = object.getWorldTransform();
        const btRigidBody* rigid = btRigidBody::upcast(&object);
        if (rigid != nullptr && !rigid->isStaticObject())
            btTransformUtil::integrateTransform(object.getWorldTransform(), rigid->getLinearVelocity(),
                                                rigid->getAngularVelocity(), -seconds, pose);
        return pose;
    }

    std::vector<PlacedShape> shapes_, last_; ///< ascending by key
};

/// Keeps the nodes of a soft body out of the MapShapes near it, from step to step.
class NodeKeeper {
  public:
    /// At the end of a step. @param near  the shapes that nodes may have met
    void keep_outside(btSoftBody& body, std::span<const PlacedShape* const> near) {
        if (near.empty() || !(body.m_sst.sdt > 0)) return collision_.reset();
        if (!goes_on(near)) begin(body, near);
        for (std::size_t i = 0; i < near.size(); ++i) {
            shapes_[i] = *near[i];
            collision_->set_collider_pose(i, around_origin(near[i]->pose));
            collision_->set_collider_friction(i, friction(body, *near[i]));
        }
        load(body);
        const SolverStep step{previous_, positions_, velocities_, inverse_masses_};
        const auto corrected = collision_->correct(step, double{body.m_sst.sdt});
        for (const std::uint32_t i : corrected) {
            btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            node.m_x = to_bullet(Vec3d(positions_[i]) + origin_);
            node.m_v = to_bullet(velocities_[i]);
        }
        if (!corrected.empty()) body.activate();
    }

  private:
    static constexpr double kMost = 1e9; ///< the largest that ParticleCollision accepts

    /// Whether the same shapes are near as in the last step, and begin at the poses that they had then.
    bool goes_on(std::span<const PlacedShape* const> near) const {
        return collision_ &&
               std::ranges::equal(near, shapes_, [](const PlacedShape* now, const PlacedShape& last) {
                   return now->key() == last.key() && now->object == last.object &&
                          now->shape == last.shape && now->shape->getLocalScaling() == last.scale &&
                          now->previous_pose == last.pose;
               });
    }
    void begin(const btSoftBody& body, std::span<const PlacedShape* const> near) {
        shapes_.clear();
        origin_ = {};
        // Doubles are rounded to floats around the body, floats not at all.
        if (sizeof(btScalar) > sizeof(float)) origin_ = to_echinus(body.m_nodes[0].m_x);
        if (!is_finite(origin_)) origin_ = {};
        std::vector<Collider> colliders;
        for (const PlacedShape* shape : near) {
            shapes_.push_back(*shape);
            colliders.push_back(shape->shape->at(shape->previous_pose));
            colliders.back().pose = around_origin(shape->previous_pose);
        }
        collision_.emplace(std::move(colliders), gap(body, near));
    }

    /// The distance from the surface to which a node is moved: large enough for floats, and too small to be
    /// visible. Far from the origin it is a few times the spacing of Bullet's numbers there.
    static double gap(const btSoftBody& body, std::span<const PlacedShape* const> near) {
        double gap = double{SIMD_INFINITY}, farthest = 0;
        for (const PlacedShape* shape : near) {
            const double radius{shape->shape->radius()};
            const double margin{body.getCollisionShape()->getMargin() + shape->shape->getMargin()};
            gap = std::min(gap, std::clamp(margin, 1e-5 * radius, 1e-3 * radius));
            const btVector3 place = shape->pose.getOrigin().absolute();
            farthest = std::max(farthest, double{place[place.maxAxis()]});
        }
        return std::min(kMost,
                        std::max(gap, 4 * double{std::numeric_limits<btScalar>::epsilon()} * farthest));
    }
    /// Bullet accepts any numbers.
    static double friction(const btSoftBody& body, const PlacedShape& shape) {
        const double friction{body.m_cfg.kDF * shape.object->getFriction()};
        return friction > 0 ? std::min(friction, kMost) : 0;
    }

    RigidTransform around_origin(const btTransform& pose) const {
        RigidTransform result = to_echinus(pose);
        result.translation = result.translation - origin_;
        return result;
    }
    Vec3f around_origin(const btVector3& point) const { return Vec3f(to_echinus(point) - origin_); }

    void load(const btSoftBody& body) {
        const auto count = static_cast<std::size_t>(body.m_nodes.size());
        for (auto* vectors : {&previous_, &positions_, &velocities_}) vectors->resize(count);
        inverse_masses_.resize(count);
        const bool sleeps = !body.isActive(); // a sleeping body does not move
        for (std::size_t i = 0; i < count; ++i) {
            const btSoftBody::Node& node = body.m_nodes[static_cast<int>(i)];
            positions_[i] = around_origin(node.m_x);
            previous_[i] = sleeps ? positions_[i] : around_origin(node.m_q);
            velocities_[i] = Vec3f(to_echinus(node.m_v));
            const bool is_held = node.m_im == 0 || node.m_battach != 0;
            inverse_masses_[i] = is_held ? 0.0F : 1.0F;
        }
    }

    std::vector<PlacedShape> shapes_;            ///< in the last step
    std::optional<ParticleCollision> collision_; ///< with these
    Vec3d origin_;                               ///< of its world
    std::vector<Vec3f> previous_, positions_, velocities_;
    std::vector<float> inverse_masses_;
};

/// Bullet's default solver of soft bodies, which after each step also moves nodes that entered a MapShape
/// back to its surface. Pass it to btSoftRigidDynamicsWorld as the last argument:
///
///     echinus::bullet::Solver solver(dispatcher);
///     btSoftRigidDynamicsWorld world(&dispatcher, &broadphase, &rigid_solver, &configuration, &solver);
///
/// No node ends a step inside, or on the other side of a thin part, however fast the node and the collider
/// are: each node is swept from its position at the start of the step to that at the end, in the frame of the
/// collider, which Bullet or setWorldTransform() moved since the end of the last step. Exceptions are pinned
/// and anchored nodes, and nodes that several colliders squeeze. In the first step of a collider near soft
/// bodies its previous pose is extrapolated from its velocity; for a kinematic body this is wrong in
/// sub-steps. A node that begins inside is moved to the nearest point of the surface.
///
/// Each step of a world with soft bodies visits all objects of its broad phase once: about 0.05 microseconds
/// for an object without a MapShape, 0.15 for one with a MapShape.
///
/// The solver must outlive the world, and the dispatcher must not be used without it. Like Bullet's soft
/// bodies themselves it supports one thread only: neither btCollisionDispatcherMt nor a deformable world
/// (btDeformableMultiBodyDynamicsWorld), which has a solver of another kind.
class Solver : public btDefaultSoftBodySolver {
  public:
    /// Registers itself for pairs of a soft body and a shape of MapShape's type.
    explicit Solver(btCollisionDispatcher& dispatcher) : dispatcher_(dispatcher), create_(*this) {
        dispatcher.registerCollisionCreateFunc(SOFTBODY_SHAPE_PROXYTYPE, FAST_CONCAVE_MESH_PROXYTYPE,
                                               &create_);
        dispatcher.registerCollisionCreateFunc(FAST_CONCAVE_MESH_PROXYTYPE, SOFTBODY_SHAPE_PROXYTYPE,
                                               &create_);
    }
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    /// @throws Error InvalidOptions for a margin of a soft body that is not from 0 to kLargestMargin
    void predictMotion(btScalar seconds) override {
        for (int i = 0; i < m_softBodySet.size(); ++i)
            check_margin(m_softBodySet[i]->getCollisionShape()->getMargin(), "a soft body");
        btDefaultSoftBodySolver::predictMotion(seconds);
    }

    void solveConstraints(btScalar seconds) override {
        for (int i = 0; i < m_softBodySet.size(); ++i)
            if (m_softBodySet[i]->isActive()) add_contacts(*m_softBodySet[i]);
        btDefaultSoftBodySolver::solveConstraints(seconds);
        if (m_softBodySet.size() == 0)
            shapes_.clear();
        else
            shapes_.update(broadphase(), seconds);
        // A keeper that gets another body detects that nothing continues.
        keepers_.resize(static_cast<std::size_t>(m_softBodySet.size()));
        for (int i = 0; i < m_softBodySet.size(); ++i) {
            find_near(*m_softBodySet[i]);
            keepers_[static_cast<std::size_t>(i)].keep_outside(*m_softBodySet[i], near_);
        }
        for (SoftBodyPair* pair : pairs_) pair->end_step();
    }

  private:
    /// All shapes near the soft body are queried in one call.
    void add_contacts(const btSoftBody& body) {
        beside_.clear();
        placed_.clear();
        btScalar margin = 0; // the largest
        for (SoftBodyPair* pair : pairs_) {
            if (!pair->has_contacts(body)) continue;
            beside_.push_back(pair);
            placed_.push_back(pair->now());
            margin = btMax(margin, pair->margin());
        }
        if (beside_.empty()) return;
        contacts_.find(placed_, body, margin);
        for (std::size_t k = 0; k < contacts_.count(); ++k) {
            SoftBodyPair& pair = *beside_[contacts_.collider(k)];
            if (-contacts_.depth(k) <= pair.margin())
                pair.add_contact(contacts_.node(k), contacts_.point(k), contacts_.normal(k));
        }
    }

    /// Bullet itself sets the boxes of soft bodies there.
    btBroadphaseInterface& broadphase() const { return *m_softBodySet[0]->getWorldInfo()->m_broadphase; }

    void find_near(btSoftBody& body) {
        near_.clear();
        const NodeBoxes nodes(body);
        for (const PlacedShape& shape : shapes_.all())
            if (shape.is_somewhere() && shape.is_near(nodes) && may_meet(body, *shape.object))
                near_.push_back(&shape);
    }

    bool may_meet(btSoftBody& body, btCollisionObject& object) {
        if (!wants_contact(body, object) || !body.hasContactResponse() || !object.hasContactResponse())
            return false;
        const auto is_reported = [&](const SoftBodyPair* pair) { return pair->is_of(body, object); };
        return std::ranges::any_of(pairs_, is_reported) || would_be_reported(body, object);
    }

    /// Bullet searches for pairs with an object's pose at the end of the step, or with a compound's at the
    /// beginning. For the pairs that it missed, its filters are called here.
    bool would_be_reported(btSoftBody& body, btCollisionObject& object) {
        btBroadphaseProxy &first = *body.getBroadphaseHandle(), &second = *object.getBroadphaseHandle();
        btOverlappingPairCache& cache = *broadphase().getOverlappingPairCache();
        if (!cache.needsBroadphaseCollision(&first, &second)) return false;
        btBroadphasePair pair(first, second);
        dispatcher_.getNearCallback()(pair, dispatcher_, btDispatcherInfo());
        const bool is_reported = pair.m_algorithm != nullptr;
        cache.cleanOverlappingPair(pair, &dispatcher_);
        return is_reported;
    }

    /// Bullet stores one for each pair, in pieces of memory that are as large as its own largest algorithm.
    class Algorithm : public btCollisionAlgorithm {
      public:
        Algorithm(const btCollisionAlgorithmConstructionInfo& info, Solver& solver)
            : btCollisionAlgorithm(info), solver_(solver), pair_(std::make_unique<SoftBodyPair>()) {
            solver_.pairs_.push_back(pair_.get());
        }
        ~Algorithm() override { std::erase(solver_.pairs_, pair_.get()); }
        Algorithm(const Algorithm&) = delete;
        Algorithm& operator=(const Algorithm&) = delete;

        void processCollision(const btCollisionObjectWrapper* first, const btCollisionObjectWrapper* second,
                              const btDispatcherInfo&, btManifoldResult*) override {
            if (!first->getCollisionShape()->isSoftBody()) std::swap(first, second);
            auto* object = const_cast<btCollisionObject*>(first->getCollisionObject());
            btSoftBody& body = *btSoftBody::upcast(object);
            if (body.getSoftBodySolver() != &solver_) throw_no_solver();
            pair_->begin_step(body, *second);
        }
        btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                       btManifoldResult*) override {
            return 1;
        }
        void getAllContactManifolds(btManifoldArray&) override {}

      private:
        Solver& solver_;
        std::unique_ptr<SoftBodyPair> pair_;
    };

    struct Create : btCollisionAlgorithmCreateFunc {
        explicit Create(Solver& solver) : solver_(solver) {}
        btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                       const btCollisionObjectWrapper*,
                                                       const btCollisionObjectWrapper*) override {
            return new (info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(Algorithm)))
                Algorithm(info, solver_);
        }
        Solver& solver_;
    };

    btCollisionDispatcher& dispatcher_;
    Create create_;
    PlacedShapes shapes_;
    std::vector<SoftBodyPair*> pairs_;     ///< that the broad phase reports; each belongs to an Algorithm
    std::vector<SoftBodyPair*> beside_;    ///< the pairs of one soft body
    std::vector<Collider> placed_;         ///< their shapes
    NodeContacts contacts_;                ///< with the shapes in placed_
    std::vector<const PlacedShape*> near_; ///< those that one soft body's nodes may have met
    std::vector<NodeKeeper> keepers_;      ///< [soft body]
};

} // namespace echinus::bullet
