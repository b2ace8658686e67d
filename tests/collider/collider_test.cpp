#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace echinus;

namespace {

const DistanceMap& torus_map() {
    static const DistanceMap map =
        DistanceMap::build(make_torus(1, 0.4, 24, 12), {.longitude_count = 64, .colatitude_count = 64});
    return map;
}

Collider placed_torus() {
    return {.map = torus_map(),
            .pose = {Rotation::about({3, -1, 2}, 1.1), {10, -20, 30}},
            .scale = {2.5, 2.5, 2.5}};
}

std::vector<Vec3f> points_around(const Collider& collider, std::size_t count) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> coordinate(-1.6, 1.6);
    std::vector<Vec3f> points;
    while (points.size() < count) {
        const Vec3d local{coordinate(engine), coordinate(engine), coordinate(engine)};
        points.emplace_back(collider.pose.to_world(local * collider.scale.x));
    }
    return points;
}

Vec3f to_local(const Collider& collider, const Vec3f& point_world) {
    return Vec3f(collider.pose.to_local(Vec3d(point_world)) * (1 / collider.scale.x));
}

void expect_same(const Contact& a, const Contact& b) {
    EXPECT_EQ(a.point, b.point);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_EQ(a.face, b.face);
    EXPECT_EQ(a.inside, b.inside);
}

} // namespace

TEST(Collider, AnswersAsItsMapDoesInTheLocalFrame) {
    const Collider collider = placed_torus();
    constexpr float kMargin = 0.5F; // world units: 0.2 in the local frame
    int found = 0;
    int inside = 0;
    for (const Vec3f& point : points_around(collider, 2000)) {
        const Vec3f point_local = to_local(collider, point);
        const Contact local = contact(torus_map(), point_local, kMargin / 2.5F);
        const Contact world = contact(collider, point, kMargin);
        // The two ways to the local frame round differently: answers next to a surface or to a cell's border
        // may differ, for so few points that none is among these.
        ASSERT_EQ(world.inside, local.inside);
        ASSERT_EQ(world.found(), local.found());
        EXPECT_EQ(contains(collider, point), world.inside);
        if (!world.found()) continue;
        ++found;
        inside += world.inside ? 1 : 0;
        EXPECT_NEAR(world.depth, 2.5F * local.depth, 2e-4F);
        EXPECT_NEAR(length(to_local(collider, world.point) - local.point), 0, 1e-4F);
        EXPECT_NEAR(length(Vec3d(world.normal) - collider.pose.rotation.apply(Vec3d(local.normal))), 0, 2e-3);
        EXPECT_NEAR(length(world.point - point), std::abs(world.depth), 1e-4F);
    }
    EXPECT_GT(found, 200);
    EXPECT_GT(inside, 100);
}

TEST(Collider, ReturnsTheParticleItselfWhereItFindsNothing) {
    const Collider collider = placed_torus();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const Vec3f& point :
         {Vec3f{0.1F, 0.2F, 0.3F}, Vec3f{kInfinity, 0, 0}, Vec3f{3e38F, 3e38F, -3e38F}}) {
        const Contact nothing = contact(collider, point, 0.1F);
        EXPECT_FALSE(nothing.found());
        EXPECT_EQ(nothing.point, point);
        EXPECT_EQ(nothing.depth, 0);
        EXPECT_FALSE(contains(collider, point));
    }
    EXPECT_FALSE(contact(collider, {kNaN, 0, 0}, 0.1F).found());
    EXPECT_FALSE(contains(collider, {kNaN, 0, 0}));
}

TEST(Collider, AnswersABatchOfAnyLengthAsItAnswersEachPoint) {
    const Collider collider = placed_torus();
    const std::vector<Vec3f> points = points_around(collider, 1000);
    for (const std::size_t count : {0, 1, 255, 256, 257, 1000}) {
        const StridedSpan<const Vec3f> batch(points.data(), count);
        std::vector<Contact> contacts(count);
        std::vector<std::uint8_t> inside(count);
        contacts_batch(collider, batch, 0.3F, contacts);
        contains_batch(collider, batch, inside);
        for (std::size_t i = 0; i < count; ++i) {
            expect_same(contacts[i], contact(collider, points[i], 0.3F));
            EXPECT_EQ(inside[i], contains(collider, points[i]) ? 1 : 0);
        }
    }
}

TEST(Collider, AnswersWithItsMapsBitsWhereItStandsAtTheOrigin) {
    const Collider collider{.map = torus_map()};
    for (const Vec3f& point : points_around(collider, 1000))
        expect_same(contact(collider, point, 0.1F), contact(torus_map(), point, 0.1F));
}

TEST(Collider, FarFromTheOriginAnswersAsFinelyAsFloatPositionsAllow) {
    const DistanceMap map =
        DistanceMap::build(make_sphere(1, 60, 30), {.longitude_count = 64, .colatitude_count = 64});
    const Collider collider{.map = map, .pose = {Rotation{}, {0, 4096, 0}}};
    EXPECT_TRUE(contains(collider, {0.5F, 4096.5F, 0}));
    EXPECT_FALSE(contains(collider, {0.5F, 4097.5F, 0}));
    EXPECT_NEAR(contact(collider, {0, 4096.9F, 0}).depth, 0.1, 6e-3);
}

namespace {

Collider moving(const Vec3d& linear, const Vec3d& angular) {
    const DistanceMap map =
        DistanceMap::build(make_box({1, 1, 1}), {.longitude_count = 8, .colatitude_count = 4});
    return {.map = map,
            .pose = {Rotation::about({1, 1, 0}, 0.3), {5, 6, 7}},
            .linear_velocity = linear,
            .angular_velocity = angular};
}

/// The position after a time of a material point, given in the collider's local frame.
Vec3d material_point(Collider collider, const Vec3d& local, double seconds) {
    collider.pose = pose_after(collider, seconds);
    return collider.pose.to_world(local);
}

} // namespace

TEST(ColliderMotion, FollowsItsLinearVelocity) {
    const Vec3d moved = pose_after(moving({1, 2, 3}, {}), 0.5).translation;
    EXPECT_NEAR(length(moved - Vec3d{5.5, 7, 8.5}), 0, 1e-15);
}

TEST(ColliderMotion, TurnsAboutItsOwnTranslationInWorldAxes) {
    const Collider collider = moving({}, {0, 0, std::numbers::pi});
    const Vec3d before = collider.pose.to_world({1, 0, 0}) - collider.pose.translation;
    const Vec3d after = material_point(collider, {1, 0, 0}, 0.5) - collider.pose.translation;
    EXPECT_NEAR(length(after - Vec3d{-before.y, before.x, before.z}), 0, 1e-13);
}

TEST(ColliderMotion, InManySmallStepsEndsWhereOneLargeStepDoes) {
    Collider stepped = moving({0.3, -0.2, 0.1}, {0.5, 1, -2});
    const RigidTransform at_once = pose_after(stepped, 3);
    for (int i = 0; i < 3000; ++i) stepped.pose = pose_after(stepped, 0.001);
    for (const Vec3d& local : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(stepped.pose.to_world(local) - at_once.to_world(local)), 0, 1e-10);
}

TEST(ColliderMotion, HasTheVelocityOfItsMaterial) {
    const Collider collider = moving({0.3, -0.2, 0.1}, {0.5, 1, -2});
    const Vec3d local{0.4, -0.7, 0.2};
    constexpr double kSeconds = 1e-6;
    const Vec3d difference =
        (material_point(collider, local, kSeconds) - material_point(collider, local, -kSeconds)) *
        (1 / (2 * kSeconds));
    EXPECT_NEAR(length(velocity_at(collider, collider.pose.to_world(local)) - difference), 0, 1e-8);
    EXPECT_TRUE(collider.moves());
}

TEST(ColliderMotion, WithoutVelocityChangesNoBit) {
    const Collider collider = moving({}, {});
    const RigidTransform pose = pose_after(collider, 10);
    EXPECT_EQ(pose.translation, collider.pose.translation);
    EXPECT_EQ(pose.rotation.w, collider.pose.rotation.w);
    EXPECT_FALSE(collider.moves());
}

TEST(ColliderMotion, HeadsForAPoseAndGetsThere) {
    const RigidTransform goal{Rotation::about({3, -1, 2}, 2.9), {-1, 4, 0.5}};
    Collider collider = moving({9, 9, 9}, {7, 0, 0});
    head_for(collider, goal, 0.25);
    const RigidTransform halfway = pose_after(collider, 0.125), there = pose_after(collider, 0.25);
    for (const Vec3d& point : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(there.to_world(point) - goal.to_world(point)), 0, 1e-12);
    EXPECT_NEAR(length(halfway.translation - (collider.pose.translation + goal.translation) * 0.5), 0, 1e-12);
    EXPECT_LE(length(collider.angular_velocity), std::numbers::pi / 0.25);
}

TEST(ColliderMotion, GoesEvenlyFromKeyToKeyAndRestsBeyondThem) {
    const Vec3d axis{0.6, 0, 0.8};
    const std::vector<PoseKey> keys{{1, {Rotation::about(axis, 0.5), {0, 0, 0}}},
                                    {3, {Rotation::about(axis, 2.5), {4, 0, 2}}},
                                    {4, {Rotation::about(axis, -3.5), {4, 1, 2}}}};
    const auto expect_pose = [&](double time, double angle, const Vec3d& translation) {
        const RigidTransform pose = pose_at(keys, time);
        const RigidTransform expected{Rotation::about(axis, angle), translation};
        for (const Vec3d& point : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            EXPECT_NEAR(length(pose.to_world(point) - expected.to_world(point)), 0, 1e-12) << time;
    };
    expect_pose(-10, 0.5, {0, 0, 0});
    expect_pose(1, 0.5, {0, 0, 0});
    expect_pose(1.5, 1, {1, 0, 0.5});
    expect_pose(2.75, 2.25, {3.5, 0, 1.75});
    expect_pose(3, 2.5, {4, 0, 2});
    // From 2.5 to -3.5 the shorter way leads up, to 2 pi - 3.5.
    expect_pose(3.5, (2.5 + 2 * std::numbers::pi - 3.5) / 2, {4, 0.5, 2});
    expect_pose(1e9, -3.5, {4, 1, 2});
}

namespace {

const RigidTransform kScaledPose{Rotation::about({3, -1, 2}, 1.1), {10, -20, 30}};

const Vec3d kScales[] = {{2.5, 2.5, 2.5}, {1, 2, 0.5}, {-1, 1, 1}, {0.5, -3, -1.2}, {-2, -2, -2}};

TriangleMesh torus() {
    return make_torus(1, 0.4, 24, 12);
}

/// The mesh scaled as the collider scales it, without the pose; faces outward.
TriangleMesh stretched(TriangleMesh mesh, const Vec3d& scale) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z));
    if (scale.x * scale.y * scale.z < 0)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

Vec3f random_point(test::Random& random, const Vec3d& scale) {
    const Vec3f local = test::in_cube(random, 1.6F);
    return Vec3f(kScaledPose.to_world({local.x * scale.x, local.y * scale.y, local.z * scale.z}));
}

struct Judge {
    explicit Judge(const Vec3d& scale) : solid(stretched(torus(), scale)) {}

    bool inside(const Vec3f& p) const { return winding_number(solid, kScaledPose.to_local(Vec3d(p))) > 0.5; }
    double distance(const Vec3f& p) const { return unsigned_distance(solid, kScaledPose.to_local(Vec3d(p))); }

    TriangleMesh solid;
};

constexpr double kResolution = 3e-5; ///< of the lattice, and of floats at 30 units from the origin

} // namespace

TEST(ScaledCollider, WithAnExactMapAnswersAsTheScaledMeshDoes) {
    const ExactMap map = ExactMap::build(torus());
    test::Random random(1);
    for (const Vec3d& scale : kScales) {
        const Collider collider{.map = map, .pose = kScaledPose, .scale = scale};
        const Judge judge(scale);
        int inside = 0;
        for (int i = 0; i < 1000; ++i) {
            const Vec3f point = random_point(random, scale);
            const double distance = judge.distance(point);
            if (distance < kResolution) continue;
            const Contact found = contact(collider, point, 0.3F);
            ASSERT_EQ(contains(collider, point), judge.inside(point));
            ASSERT_EQ(found.inside, judge.inside(point));
            ASSERT_EQ(found.found(), found.inside || distance <= 0.3) << distance;
            if (!found.found()) continue;
            inside += found.inside ? 1 : 0;
            ASSERT_NEAR(std::fabs(found.depth), distance, kResolution);
            ASSERT_NEAR(judge.distance(found.point), 0, kResolution);
            const Vec3d way_out = (Vec3d(found.point) - Vec3d(point)) * (1.0 / found.depth);
            ASSERT_NEAR(length(Vec3d(found.normal) - way_out), 0, 2 * kResolution / distance + 1e-4);
        }
        EXPECT_GT(inside, 50);
    }
}

TEST(ScaledCollider, WithAnExactMapHasItsContactAtAnyDistance) {
    const TriangleMesh box = make_box({2, 2, 2}, 2);
    const ExactMap map = ExactMap::build(box);
    test::Random random(2);
    const Vec3d scale{1, 2, 0.01};
    const Collider collider{.map = map, .scale = scale};
    for (int exponent = 3; exponent < 37; ++exponent) {
        const double far = std::pow(10.0, exponent);
        std::vector<Vec3f> points;
        // Points whose nearest one is a corner, in an octant each.
        for (int i = 0; i < 16; ++i) {
            const Vec3f away = test::in_cube(random, 1);
            points.push_back({static_cast<float>(std::copysign(far, away.x)),
                              static_cast<float>(std::copysign(far / 3, away.y)),
                              static_cast<float>(std::copysign(far / 7, away.z))});
        }
        std::vector<Contact> batch(points.size());
        contacts_batch(collider, points, std::numeric_limits<float>::infinity(), batch);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3d p(points[i]);
            const Vec3d corner{std::copysign(scale.x, p.x), std::copysign(scale.y, p.y),
                               std::copysign(scale.z, p.z)};
            const double distance = length(p - corner);
            ASSERT_NEAR(batch[i].depth / distance, -1, 1e-6) << far;
            ASSERT_LT(length(Vec3d(batch[i].point) - corner), kResolution) << far;
            ASSERT_LT(length(Vec3d(batch[i].normal) - (p - corner) * (1 / distance)), 1e-5) << far;
            const auto margin = static_cast<float>(distance);
            ASSERT_EQ(contact(collider, points[i], margin * 1.001F).face, batch[i].face) << far;
            ASSERT_FALSE(contact(collider, points[i], margin * 0.999F).found()) << far;
        }
    }
}

TEST(ScaledCollider, WithADistanceMapPushesAlongTheParticlesRayByTheDepth) {
    const DistanceMap map = DistanceMap::build(torus(), {.longitude_count = 64, .colatitude_count = 64});
    test::Random random(2);
    for (const Vec3d& scale : kScales) {
        const Collider collider{.map = map, .pose = kScaledPose, .scale = scale};
        const Vec3d centre = kScaledPose.to_world(Vec3d(map.view().centre));
        int found_count = 0;
        int outwards = 0;
        for (int i = 0; i < 1000; ++i) {
            const Vec3f point = random_point(random, scale);
            constexpr float kMargin = 0.3F;
            const Contact found = contact(collider, point, kMargin);
            ASSERT_EQ(found.inside, contains(collider, point));
            if (!found.found()) continue;
            ++found_count;
            const Vec3d from_centre = Vec3d(point) - centre;
            const Vec3d way = Vec3d(found.point) - Vec3d(point);
            ASSERT_NEAR(length(cross(from_centre, way)) / length(from_centre), 0, kResolution);
            ASSERT_NEAR(length(way), std::fabs(found.depth), kResolution);
            ASSERT_EQ(found.depth > 0, found.inside);
            ASSERT_GE(found.depth, -kMargin);
            ASSERT_NEAR(length(found.normal), 1, 1e-5);
            const bool beyond = contains(collider, found.point + found.normal * 0.1F);
            const bool below = contains(collider, found.point - found.normal * 0.1F);
            outwards += !beyond && below ? 1 : 0;
        }
        EXPECT_GT(found_count, 100);
        EXPECT_GT(outwards, 0.9 * found_count);
    }
}

TEST(ScaledCollider, GivesADistanceMapsContactTheNormalOfTheScaledSurface) {
    // The top of a box stays the top; a slanted face turns towards the axis that is squeezed.
    TriangleMesh octahedron{
        .vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
        .faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    const Collider collider{.map = DistanceMap::build(octahedron), .scale = {1, -2, 0.25}};
    const Contact found = contact(collider, {0.2F, -0.4F, 0.05F});
    const Vec3d expected = Vec3d{1, -0.5, 4} * (1 / length(Vec3d{1, -0.5, 4}));
    EXPECT_NEAR(length(Vec3d(found.normal) - expected), 0, 1e-2);
}

TEST(ScaledCollider, AnswersABatchAsItAnswersEachPoint) {
    const ExactMap exact = ExactMap::build(torus());
    const DistanceMap sampled = DistanceMap::build(torus(), {.longitude_count = 64, .colatitude_count = 64});
    test::Random random(3);
    for (const AnyMap& map : {AnyMap(exact), AnyMap(sampled)}) {
        const Collider collider{.map = map, .pose = kScaledPose, .scale = {0.5, -3, -1.2}};
        std::vector<Vec3f> points;
        for (int i = 0; i < 600; ++i) points.push_back(random_point(random, collider.scale));
        std::vector<Contact> contacts(points.size());
        std::vector<std::uint8_t> inside(points.size());
        contacts_batch(collider, points, 0.3F, contacts);
        contains_batch(collider, points, inside);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Contact one = contact(collider, points[i], 0.3F);
            EXPECT_EQ(contacts[i].point, one.point);
            EXPECT_EQ(contacts[i].normal, one.normal);
            EXPECT_EQ(contacts[i].depth, one.depth);
            EXPECT_EQ(contacts[i].face, one.face);
            EXPECT_EQ(contacts[i].feature, one.feature);
            EXPECT_EQ(contacts[i].certain, one.certain);
            EXPECT_EQ(inside[i], contains(collider, points[i]) ? 1 : 0);
        }
    }
}

TEST(ScaledCollider, PassesOnTheFaceTheFeatureAndTheMarkOfCertainty) {
    TriangleMesh open = make_sphere(1, 24, 12);
    open.faces.resize(open.faces.size() * 3 / 4);
    const ExactMap map = ExactMap::build(open);
    const Collider collider{.map = map, .pose = kScaledPose, .scale = {2, 2, 2}};
    test::Random random(4);
    int uncertain = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3f point = random_point(random, collider.scale);
        const Vec3f local(kScaledPose.to_local(Vec3d(point)) * 0.5);
        const Contact expected = contact(map, local, 0.2F);
        const Contact found = contact(collider, point, 0.4F);
        if (expected.inside != found.inside) continue; // two roundings to the local frame
        EXPECT_EQ(found.certain, expected.certain);
        uncertain += found.certain ? 0 : 1;
        if (!found.found() || found.face != expected.face) continue;
        EXPECT_EQ(found.feature, expected.feature);
    }
    EXPECT_GT(uncertain, 10);
}
