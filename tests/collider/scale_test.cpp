#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

using namespace echinus;

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
