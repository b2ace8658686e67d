// The adapter for Bullet, in worlds as its users have them. Sides are judged by a winding number over all
// faces.

#include "support/expectations.hpp"

#include <echinus/bullet.hpp>
#include <echinus/mesh.hpp>

#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

using namespace echinus;
using test::expect_error;

namespace {

constexpr btScalar kMargin = btScalar(0.02);
constexpr int kSide = 20; // nodes of a cloth

/// A world of Bullet's; z is up.
class World {
  public:
    explicit World(bool with_solver = true) {
        if (with_solver) solver_ = std::make_unique<bullet::Solver>(dispatcher_);
        world_ = std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher_, &broadphase_, &rigid_solver_,
                                                            &configuration_, solver_.get());
        world_->setGravity({0, 0, btScalar(-9.81)});
        world_->getWorldInfo().m_gravity.setValue(0, 0, btScalar(-9.81));
    }
    ~World() {
        for (const auto& cloth : cloths_) world_->removeSoftBody(cloth.get());
        for (const auto& body : bodies_) world_->removeRigidBody(body.get());
    }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    btRigidBody& add(btCollisionShape& shape, const btTransform& pose = btTransform::getIdentity(),
                     btScalar mass = 0) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform = pose;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        world_->addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }
    btRigidBody& add_kinematic(btCollisionShape& shape, const btTransform& pose) {
        btRigidBody& body = add(shape, pose);
        body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        body.setActivationState(DISABLE_DEACTIVATION);
        return body;
    }
    /// A level square sheet around (x, 0, height). @param fixed  corners, as CreatePatch() has them
    btSoftBody& add_cloth(btScalar size, btScalar height, int fixed = 0, btScalar x = 0) {
        const btScalar half = size / 2;
        cloths_.emplace_back(btSoftBodyHelpers::CreatePatch(
            world_->getWorldInfo(), {x - half, -half, height}, {x + half, -half, height},
            {x - half, half, height}, {x + half, half, height}, kSide, kSide, fixed, true));
        btSoftBody& cloth = *cloths_.back();
        cloth.getCollisionShape()->setMargin(kMargin);
        cloth.setTotalMass(1);
        cloth.m_cfg.piterations = 10;
        cloth.m_cfg.kDF = 1;
        cloth.m_cfg.kKHR = 1;
        cloth.setActivationState(DISABLE_DEACTIVATION);
        world_->addSoftBody(&cloth);
        return cloth;
    }
    void step(int frames, btScalar rate = 60) {
        for (int frame = 0; frame < frames; ++frame) world_->stepSimulation(1 / rate, 0);
    }
    void step_with_substeps(int count) { world_->stepSimulation(btScalar(count) / 60, count); }
    btCollisionDispatcher& dispatcher() { return dispatcher_; }

  private:
    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver rigid_solver_;
    std::unique_ptr<bullet::Solver> solver_;
    std::unique_ptr<btSoftRigidDynamicsWorld> world_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btSoftBody>> cloths_;
};

TriangleMesh torus() {
    return make_torus(1, 0.4, 30, 12);
}

btTransform at(btScalar x, btScalar y, btScalar z) {
    return btTransform(btQuaternion::getIdentity(), {x, y, z});
}

btTransform turned(const btVector3& axis, btScalar angle) {
    return btTransform(btQuaternion(axis, angle), {0, 0, 0});
}

/// Nodes inside a mesh that stands at a pose, with a scale.
int inside_count(const btSoftBody& cloth, const TriangleMesh& mesh,
                 const btTransform& pose = btTransform::getIdentity(), const btVector3& scale = {1, 1, 1}) {
    int count = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) {
        const btVector3 local = pose.invXform(cloth.m_nodes[i].m_x) / scale;
        if (std::fabs(winding_number(mesh, bullet::to_echinus(local))) > 0.5) ++count;
    }
    return count;
}

btScalar highest(const btSoftBody& cloth) {
    btScalar height = -SIMD_INFINITY;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) height = btMax(height, cloth.m_nodes[i].m_x.z());
    return height;
}

std::vector<btVector3> places_of(const btSoftBody& cloth) {
    std::vector<btVector3> places;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) places.push_back(cloth.m_nodes[i].m_x);
    return places;
}

/// Nodes that started near the axis, within a distance along x and y, and are below a height now.
int count_below(const btSoftBody& cloth, std::span<const btVector3> start, btScalar distance,
                btScalar height) {
    int count = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) {
        const btVector3 place = start[static_cast<std::size_t>(i)].absolute();
        if (place.x() < distance && place.y() < distance && cloth.m_nodes[i].m_x.z() < height) ++count;
    }
    return count;
}

/// Of a coordinate of all nodes.
btScalar mean_of(const btSoftBody& cloth, int axis) {
    btScalar sum = 0;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) sum += cloth.m_nodes[i].m_x[axis];
    return sum / btScalar(cloth.m_nodes.size());
}

} // namespace

TEST(BulletAdapter, ClothThatFallsThroughBulletsMeshLiesOnTheSameMeshAsAMap) {
    const TriangleMesh mesh = torus();
    btTriangleMesh triangles;
    for (const Triangle& f : mesh.faces)
        triangles.addTriangle(bullet::to_bullet(mesh.vertices[f[0]]), bullet::to_bullet(mesh.vertices[f[1]]),
                              bullet::to_bullet(mesh.vertices[f[2]]));
    btBvhTriangleMeshShape stock(&triangles, true);
    World without(false);
    without.add(stock);
    const btSoftBody& fallen = without.add_cloth(2.4, 0.5);
    without.step(90);
    EXPECT_TRUE(inside_count(fallen, mesh) > 0 || highest(fallen) < 0) << "there is nothing to mend";

    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    world.add(shape);
    const btSoftBody& cloth = world.add_cloth(2.4, 0.5);
    for (int frame = 0; frame < 90; ++frame) {
        world.step(1);
        if (frame % 10 == 9) ASSERT_EQ(inside_count(cloth, mesh), 0) << "frame " << frame;
    }
    EXPECT_GT(highest(cloth), btScalar(0.3));
}

TEST(BulletAdapter, FastClothDoesNotPassAThinPlate) {
    const TriangleMesh plate = make_box({2, 2, 0.002});
    bullet::MapShape shape(ExactMap::build(plate));
    World world;
    world.add(shape);
    btSoftBody& cloth = world.add_cloth(1, 1);
    cloth.setVelocity({0, 0, -200}); // 3.3 a frame
    world.step(20);
    for (int i = 0; i < cloth.m_nodes.size(); ++i) ASSERT_GT(cloth.m_nodes[i].m_x.z(), btScalar(0.001)) << i;
}

TEST(BulletAdapter, KinematicColliderThatIsLedThroughAClothTakesItAlong) {
    const TriangleMesh mesh = torus();
    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    btRigidBody& collider = world.add_kinematic(shape, at(0, 0, -1));
    const btSoftBody& cloth = world.add_cloth(2.4, 0);
    for (int frame = 1; frame <= 60; ++frame) {
        const btTransform pose(btQuaternion({0, 1, 0}, btScalar(frame) / 40),
                               {0, 0, btScalar(-1) + btScalar(frame) / 20});
        collider.setWorldTransform(pose);
        world.step(1);
        if (frame % 10 == 0) ASSERT_EQ(inside_count(cloth, mesh, pose), 0) << "frame " << frame;
    }
    EXPECT_GT(highest(cloth), 1);
}

TEST(BulletAdapter, KinematicColliderThatLeapsOverAClothTakesItAlong) {
    bullet::MapShape shape(ExactMap::build(make_box({0.6, 0.6, 0.1})));
    for (const int substeps : {1, 4})
        for (const btScalar leap : {btScalar(1.5), btScalar(6)}) {
            World world;
            btRigidBody& plate = world.add_kinematic(shape, at(0, 0, -leap * btScalar(1.7)));
            const btSoftBody& cloth = world.add_cloth(2, 0);
            world.step(1);
            const std::vector<btVector3> start = places_of(cloth);
            for (const btScalar height : {-leap * btScalar(0.7), leap * btScalar(0.3)}) {
                plate.setWorldTransform(at(0, 0, height));
                world.step_with_substeps(substeps);
            }
            EXPECT_EQ(count_below(cloth, start, btScalar(0.25), leap * btScalar(0.3)), 0)
                << substeps << " sub-steps, " << leap;
        }
}

TEST(BulletAdapter, FastDynamicCompoundTakesAClothAlong) {
    bullet::MapShape shape(ExactMap::build(make_box({3, 3, 0.1})));
    btCompoundShape compound;
    compound.addChildShape(btTransform::getIdentity(), &shape);
    World world;
    btRigidBody& plate = world.add(compound, at(0, 0, btScalar(-17.6)), 1000);
    plate.setLinearVelocity({0, 0, 300}); // 5 a frame
    const btSoftBody& cloth = world.add_cloth(2, 0);
    const std::vector<btVector3> start = places_of(cloth);
    world.step(8);
    EXPECT_EQ(count_below(cloth, start, 1, plate.getWorldTransform().getOrigin().z()), 0);
}

TEST(BulletAdapter, StaticColliderThatIsPutOnTheOtherSideTakesAClothAlong) {
    bullet::MapShape shape(ExactMap::build(make_box({0.6, 0.6, 0.1})));
    World world;
    btRigidBody& plate = world.add(shape, at(0, 0, -3));
    const btSoftBody& cloth = world.add_cloth(2, 0);
    const std::vector<btVector3> start = places_of(cloth);
    world.step(1);
    plate.setWorldTransform(at(0, 0, 3));
    world.step(1);
    EXPECT_EQ(count_below(cloth, start, btScalar(0.25), 3), 0);
}

TEST(BulletAdapter, ChildOfACompoundThatLeapsInItTakesAClothAlong) {
    bullet::MapShape shape(ExactMap::build(make_box({0.6, 0.6, 0.1})));
    btCompoundShape compound;
    compound.addChildShape(at(9, 0, 0), &shape);
    compound.addChildShape(at(0, 0, -3), &shape);
    World world;
    world.add(compound);
    const btSoftBody& cloth = world.add_cloth(2, 0);
    const std::vector<btVector3> start = places_of(cloth);
    world.step(1);
    compound.updateChildTransform(1, at(0, 0, 3));
    world.step(1);
    EXPECT_EQ(count_below(cloth, start, btScalar(0.25), 3), 0);
}

TEST(BulletAdapter, BulletsFiltersHoldForAColliderThatLeapsOverACloth) {
    bullet::MapShape shape(ExactMap::build(make_box({0.6, 0.6, 0.1})));
    const auto mean_after_leap = [&](auto&& filter) {
        World world;
        btRigidBody& plate = world.add_kinematic(shape, at(0, 0, -3));
        btSoftBody& cloth = world.add_cloth(2, 0);
        filter(world, plate, cloth);
        world.step(1);
        plate.setWorldTransform(at(0, 0, 3));
        world.step(1);
        return mean_of(cloth, 2);
    };
    EXPECT_GT(mean_after_leap([](World&, btRigidBody&, btSoftBody&) {}), btScalar(0.1));
    const auto expect_untouched = [&](const char* filter, auto&& set) {
        EXPECT_NEAR(mean_after_leap(set), 0, btScalar(0.01)) << filter;
    };
    expect_untouched("groups", [](World&, btRigidBody& plate, btSoftBody&) {
        plate.getBroadphaseHandle()->m_collisionFilterMask = 0;
    });
    expect_untouched("near callback", [](World& world, btRigidBody&, btSoftBody&) {
        world.dispatcher().setNearCallback(
            [](btBroadphasePair&, btCollisionDispatcher&, const btDispatcherInfo&) {});
    });
    expect_untouched("one object", [](World&, btRigidBody& plate, btSoftBody& cloth) {
        cloth.m_collisionDisabledObjects.push_back(&plate);
    });
    expect_untouched("ignored", [](World&, btRigidBody& plate, btSoftBody& cloth) {
        cloth.setIgnoreCollisionCheck(&plate, true);
    });
}

TEST(BulletAdapter, ColliderThatPassedAClothWithoutContactDoesNotTakeItAlongLater) {
    bullet::MapShape shape(ExactMap::build(make_box({1, 1, 0.2})));
    World world;
    btRigidBody& plate = world.add_kinematic(shape, at(0, 0, btScalar(-0.5)));
    btSoftBody& cloth = world.add_cloth(2, 0, 15);
    world.step(1);
    cloth.m_collisionDisabledObjects.push_back(&plate);
    plate.setWorldTransform(at(0, 0, btScalar(0.5)));
    world.step(1);
    cloth.m_collisionDisabledObjects.clear();
    world.step(1);
    EXPECT_LT(highest(cloth), btScalar(0.01));
}

TEST(BulletAdapter, DynamicBodyIsStoppedByAClothThatHoldsIt) {
    const TriangleMesh mesh = make_sphere(0.3, 16, 8);
    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    const btRigidBody& ball = world.add(shape, at(0, 0, btScalar(0.6)), btScalar(0.2));
    const btSoftBody& cloth = world.add_cloth(2, 0, 15); // all corners
    for (int frame = 0; frame < 90; ++frame) {
        world.step(1);
        if (frame % 10 == 9)
            ASSERT_EQ(inside_count(cloth, mesh, ball.getWorldTransform()), 0) << "frame " << frame;
    }
    EXPECT_GT(ball.getWorldTransform().getOrigin().z(), btScalar(-1.5)) << "a free fall ends at -10";
}

TEST(BulletAdapter, FrictionOfBothDecidesWhetherAClothSlides) {
    bullet::MapShape shape(ExactMap::build(make_box({6, 6, 1})));
    const btTransform slope = turned({0, 1, 0}, std::numbers::pi_v<btScalar> / 12);
    const auto slid = [&](btScalar friction) {
        World world;
        world.add(shape, slope).setFriction(friction);
        btSoftBody& cloth = world.add_cloth(1, 0);
        cloth.transform(slope * at(0, 0, btScalar(0.5) + kMargin));
        const btScalar start = mean_of(cloth, 0);
        world.step(60);
        return mean_of(cloth, 0) - start;
    };
    EXPECT_LT(std::fabs(slid(1)), btScalar(0.1));
    EXPECT_GT(slid(0), btScalar(0.5));
}

TEST(BulletAdapter, FrictionHoldsNodesThatWerePutBackBeforeTheyHadAContact) {
    bullet::MapShape shape(ExactMap::build(make_box({2, 2, 0.002})));
    const auto slid = [&](btScalar friction) {
        World world;
        world.add(shape).setFriction(friction);
        btSoftBody& cloth = world.add_cloth(1, btScalar(0.5));
        cloth.setVelocity({20, 0, -200}); // in one step past the plate
        world.step(1);
        return mean_of(cloth, 0);
    };
    EXPECT_NEAR(slid(1), 0, btScalar(0.01));
    EXPECT_NEAR(slid(0), btScalar(20) / 60, btScalar(0.01));
}

TEST(BulletAdapter, ClothRestsAtTheMarginOfBoth) {
    const TriangleMesh box = make_box({3, 3, 1});
    for (const btScalar own : {btScalar(0), btScalar(0.05)}) {
        bullet::MapShape shape(ExactMap::build(box));
        shape.setMargin(own);
        World world;
        world.add(shape);
        const btSoftBody& cloth = world.add_cloth(1, btScalar(0.7));
        world.step(60);
        btScalar lowest = SIMD_INFINITY; // Bullet lets what it pushed to the margin hop a little
        for (int frame = 0; frame < 60; ++frame) {
            world.step(1);
            lowest = btMin(lowest, mean_of(cloth, 2));
        }
        EXPECT_NEAR(lowest, btScalar(0.5) + kMargin + own, btScalar(0.006));
    }
}

TEST(BulletAdapter, TwoSoftBodiesLieOnOneShapeOfTwoObjects) {
    const TriangleMesh mesh = torus();
    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    const btTransform left = at(-2, 0, 0), right = at(2, 0, 0);
    world.add(shape, left);
    world.add(shape, right);
    const btSoftBody& first = world.add_cloth(2, 0.5, 0, -2);
    const btSoftBody& second = world.add_cloth(2, 0.6, 0, 2);
    world.step(60);
    EXPECT_EQ(inside_count(first, mesh, left), 0);
    EXPECT_EQ(inside_count(second, mesh, right), 0);
    EXPECT_GT(highest(first), btScalar(0.3));
    EXPECT_GT(highest(second), btScalar(0.3));
}

TEST(BulletAdapter, AScaledAndMirroredShapeIsTheScaledMesh) {
    const TriangleMesh mesh = torus();
    const btVector3 scale(btScalar(-1.2), btScalar(0.8), btScalar(0.5));
    bullet::MapShape shape(ExactMap::build(mesh));
    shape.setLocalScaling(scale);
    World world;
    world.add(shape);
    const btSoftBody& cloth = world.add_cloth(2.4, 0.3);
    world.step(60);
    EXPECT_EQ(inside_count(cloth, mesh, btTransform::getIdentity(), scale), 0);
    EXPECT_GT(highest(cloth), btScalar(0.15));
}

TEST(BulletAdapter, AShapeInACompoundStandsWhereTheCompoundHasIt) {
    const TriangleMesh mesh = torus();
    bullet::MapShape shape(ExactMap::build(mesh));
    btCompoundShape compound;
    const btTransform in_compound = at(0, 0, -1), pose = turned({1, 0, 0}, btScalar(0.3));
    compound.addChildShape(in_compound, &shape);
    World world;
    world.add(compound, pose);
    const btSoftBody& cloth = world.add_cloth(2, 0.2);
    world.step(60);
    EXPECT_EQ(inside_count(cloth, mesh, pose * in_compound), 0);
    EXPECT_GT(highest(cloth), btScalar(-0.8));
}

TEST(BulletAdapter, NodesThatBeginInsideAreBroughtOut) {
    const TriangleMesh mesh = torus();
    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    world.add(shape);
    const btSoftBody& cloth = world.add_cloth(2, 0);
    ASSERT_GT(inside_count(cloth, mesh), 0);
    world.step(1);
    EXPECT_EQ(inside_count(cloth, mesh), 0);
}

TEST(BulletAdapter, PinnedNodesStayWhereTheyAre) {
    bullet::MapShape shape(ExactMap::build(torus()));
    World world;
    world.add(shape, at(1, 0, 0));
    const btSoftBody& cloth = world.add_cloth(2, 0, 1);
    const auto pinned = std::find_if(&cloth.m_nodes[0], &cloth.m_nodes[0] + cloth.m_nodes.size(),
                                     [](const auto& node) { return node.m_im == 0; });
    const btVector3 place = pinned->m_x;
    world.step(30);
    EXPECT_EQ(pinned->m_x, place);
}

TEST(BulletAdapter, ObjectsWithoutContactResponseLetClothThrough) {
    bullet::MapShape shape(ExactMap::build(torus()));
    World world;
    btRigidBody& ghost = world.add(shape);
    ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    const btSoftBody& cloth = world.add_cloth(2, 0.5);
    world.step(60);
    EXPECT_LT(highest(cloth), btScalar(-2));
}

TEST(BulletAdapter, RigidBodiesMeetTheTrianglesThatTheShapeWasGiven) {
    const TriangleMesh box = make_box({2, 2, 1});
    btTriangleMesh triangles;
    for (const Triangle& f : box.faces)
        triangles.addTriangle(bullet::to_bullet(box.vertices[f[0]]), bullet::to_bullet(box.vertices[f[1]]),
                              bullet::to_bullet(box.vertices[f[2]]));
    const btBvhTriangleMeshShape stock(&triangles, true);
    const auto height_after_a_second = [&](const btConcaveShape* for_rigid_bodies) {
        bullet::MapShape shape(ExactMap::build(box), for_rigid_bodies);
        btSphereShape ball(btScalar(0.2));
        World world;
        world.add(shape);
        const btRigidBody& falling = world.add(ball, at(0, 0, 1), 1);
        world.step(60);
        return falling.getWorldTransform().getOrigin().z();
    };
    EXPECT_NEAR(height_after_a_second(&stock), btScalar(0.7), btScalar(0.1));
    EXPECT_LT(height_after_a_second(nullptr), 0);
}

TEST(BulletAdapter, OneClothKeepsTheMarginOfEachShapeThatItLiesOn) {
    const TriangleMesh box = make_box({1, 3, 1});
    const ExactMap map = ExactMap::build(box);
    bullet::MapShape low(map), high(map);
    high.setMargin(btScalar(0.1));
    World world;
    world.add(low, at(btScalar(-0.6), 0, 0));
    world.add(high, at(btScalar(0.6), 0, 0));
    const btSoftBody& cloth = world.add_cloth(2, btScalar(0.7));
    world.step(90);
    btScalar lowest_left = SIMD_INFINITY, lowest_right = SIMD_INFINITY;
    for (int i = 0; i < cloth.m_nodes.size(); ++i) {
        const btVector3& place = cloth.m_nodes[i].m_x;
        if (place.x() < btScalar(-0.3)) lowest_left = btMin(lowest_left, place.z());
        if (place.x() > btScalar(0.3)) lowest_right = btMin(lowest_right, place.z());
    }
    EXPECT_NEAR(lowest_left, btScalar(0.5) + kMargin, btScalar(0.01));
    EXPECT_NEAR(lowest_right, btScalar(0.5) + kMargin + btScalar(0.1), btScalar(0.01));
}

TEST(BulletAdapter, NothingIsLostAMillionAwayWhereBulletHasDoubles) {
    if (sizeof(btScalar) < sizeof(double)) GTEST_SKIP() << "Bullet's own floats are 0.06 apart there";
    const btTransform away = at(btScalar(1e6), btScalar(-1e6), btScalar(1e6));
    const TriangleMesh mesh = torus();
    const TriangleMesh plate = make_box({4, 4, 0.002});
    bullet::MapShape shape(ExactMap::build(mesh)), thin(ExactMap::build(plate));
    World world;
    btRigidBody& turning = world.add_kinematic(shape, away);
    const btTransform below = away * at(0, 0, btScalar(-0.8));
    world.add(thin, below);
    btSoftBody& cloth = world.add_cloth(3, btScalar(0.5));
    cloth.transform(away);
    for (int frame = 1; frame <= 90; ++frame) {
        const btTransform pose = away * turned({0, 0, 1}, btScalar(frame) / 100);
        turning.setWorldTransform(pose);
        world.step(1);
        ASSERT_EQ(inside_count(cloth, mesh, pose), 0) << "frame " << frame;
        ASSERT_EQ(inside_count(cloth, plate, below), 0) << "frame " << frame;
    }
    btScalar lowest = SIMD_INFINITY;
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        lowest = btMin(lowest, below.invXform(cloth.m_nodes[i].m_x).z());
    EXPECT_GT(lowest, btScalar(0.001));
    EXPECT_GT(away.invXform({1e6, -1e6, highest(cloth)}).z(), btScalar(0.3));
}

TEST(BulletAdapter, TakesAnyFrictionAndLeavesOutWhatHasExploded) {
    using Limits = std::numeric_limits<btScalar>;
    const TriangleMesh mesh = make_box({3, 3, 1});
    bullet::MapShape shape(ExactMap::build(mesh));
    for (const btScalar friction : {Limits::infinity(), Limits::quiet_NaN(), btScalar(1e18), btScalar(-1)}) {
        World world;
        btRigidBody& box = world.add_kinematic(shape, at(0, 0, 0));
        box.setFriction(friction);
        const btSoftBody& cloth = world.add_cloth(1, btScalar(0.55));
        world.step(2);
        EXPECT_EQ(inside_count(cloth, mesh), 0);
        box.setWorldTransform(at(0, 0, Limits::quiet_NaN()));
        EXPECT_NO_THROW(world.step(2));
    }
}

TEST(BulletAdapter, NamesAMeshFarAwayAnOpenSurfaceAndAScaleOfZero) {
    TriangleMesh far = torus();
    far.origin = {448262, 5411932, 112};
    expect_error(ErrorCode::InvalidMesh, "too far from 0", [&] { bullet::MapShape(ExactMap::build(far)); });
    TriangleMesh open = torus();
    open.faces.pop_back();
    expect_error(ErrorCode::InvalidMesh, "the surface is open",
                 [&] { bullet::MapShape(ExactMap::build(open)); });
    bullet::MapShape shape(ExactMap::build(torus()));
    expect_error(ErrorCode::InvalidOptions, "scale", [&] { shape.setLocalScaling({1, 0, 1}); });
    EXPECT_EQ(shape.getLocalScaling(), btVector3(1, 1, 1));
}

TEST(BulletAdapter, NamesAMarginThatIsNotANumberOrFarTooLarge) {
    using Limits = std::numeric_limits<btScalar>;
    bullet::MapShape shape(ExactMap::build(torus()));
    for (const btScalar margin : {Limits::infinity(), Limits::quiet_NaN(), btScalar(1e9), btScalar(-1)}) {
        expect_error(ErrorCode::InvalidOptions, "the margin of a MapShape", [&] { shape.setMargin(margin); });
        EXPECT_EQ(shape.getMargin(), 0);
        World world;
        world.add_cloth(1, 0).getCollisionShape()->setMargin(margin);
        expect_error(ErrorCode::InvalidOptions, "the margin of a soft body", [&] { world.step(1); });
    }
}

TEST(BulletAdapter, NamesAWorldWithoutASolver) {
    bullet::MapShape shape(ExactMap::build(torus()));
    for (const bool is_in_dispatcher : {false, true}) {
        std::unique_ptr<bullet::Solver> not_in_world; // outlives the world
        World world(false);
        if (is_in_dispatcher) not_in_world = std::make_unique<bullet::Solver>(world.dispatcher());
        world.add(shape);
        world.add_cloth(2, 0);
        expect_error(ErrorCode::InvalidOptions, "echinus::bullet::Solver", [&] { world.step(1); });
    }
}

TEST(BulletAdapter, NodesStayOutsideWhereBulletsFloatsAreCoarse) {
    const btTransform away = at(btScalar(1e5), btScalar(1e5), 0); // floats are 0.008 apart
    const TriangleMesh mesh = torus();
    bullet::MapShape shape(ExactMap::build(mesh));
    World world;
    world.add(shape, away);
    btSoftBody& cloth = world.add_cloth(2.4, 0.5);
    cloth.transform(away);
    cloth.getCollisionShape()->setMargin(0);
    for (int frame = 0; frame < 60; ++frame) {
        world.step(1);
        ASSERT_EQ(inside_count(cloth, mesh, away), 0) << "frame " << frame;
    }
    EXPECT_GT(highest(cloth), btScalar(0.3));
}
