#include "support/meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace echinus;

namespace {

/// What the lattice and the rounding to float may change of a distance.
double tolerance(const ExactMapView& map, double distance) {
    return 4e-6 * double{map.radius} + 1e-7 * std::fabs(distance);
}

/// In the bounding sphere, near the surface, and up to a million radii away.
std::vector<Vec3f> points_near_and_far(const ExactMapView& map, const TriangleMesh& mesh) {
    test::Random random(5);
    std::vector<Vec3f> points = test::surface_points(mesh, 500);
    for (int n = 0; n < 1000; ++n) points.push_back(map.centre + test::in_cube(random, 1.5F * map.radius));
    for (float far = 2; far < 1e6F; far *= 3)
        for (int n = 0; n < 40; ++n)
            points.push_back(map.centre + test::unit_vector(random) * (far * map.radius));
    return points;
}

std::vector<TriangleMesh> closed_meshes() {
    return {make_torus(1, 0.4, 40, 16), make_box({2, 1, 0.25}, 3),
            test::translated(make_sphere(1e-3, 20, 10), {0.1F, -0.2F, 0.3F}),
            test::turned_inside_out(make_box({1, 1, 1}))};
}

} // namespace

TEST(ExactMapSignedDistance, IsTheDistanceOfTheSurfaceNegativeInside) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            const float found = signed_distance(map, p);
            ASSERT_EQ(std::signbit(found), contains(map, p));
            const double expected = unsigned_distance(mesh, Vec3d(p));
            ASSERT_NEAR(std::fabs(found), expected, tolerance(map, expected))
                << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(ExactMapSignedDistance, IsTheOppositeOfTheDepthOfAContact) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    for (const Vec3f& p : points_near_and_far(map, mesh)) {
        const Contact c = contact(map, p, std::numeric_limits<float>::infinity());
        ASSERT_TRUE(c.found());
        Vec3f gradient;
        ASSERT_EQ(signed_distance(map, p, &gradient), -c.depth);
        ASSERT_EQ(gradient, c.normal);
    }
}

TEST(ExactMapSignedDistance, ChangesNoFasterThanThePointMoves) {
    test::Random random(6);
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            const float reach = length(p - map.view().centre);
            for (const float step : {1e-6F, 1e-3F, 0.3F}) {
                const Vec3f q = p + test::unit_vector(random) * (step * reach);
                const double from = signed_distance(map, p), to = signed_distance(map, q);
                ASSERT_LE(std::fabs(from - to), length(Vec3d(p) - Vec3d(q)) + 2 * tolerance(map, from));
            }
        }
    }
}

TEST(ExactMapSignedDistance, MovesWithTheMesh) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    const ExactMap map = ExactMap::build(mesh);
    const Vec3f offset{16, -8, 32};
    const ExactMap moved = ExactMap::build(test::translated(mesh, offset));
    for (const Vec3f& p : points_near_and_far(map, mesh)) {
        const double here = signed_distance(map, p), there = signed_distance(moved, p + offset);
        const double rounding = 3e-6 + 1e-7 * double{length(p)}; // of moved vertices and points
        ASSERT_NEAR(std::fabs(here), std::fabs(there), rounding + 2 * tolerance(map, here));
    }
}

TEST(ExactMapSignedDistance, HasAUnitGradientThatLeadsFromTheNearestPoint) {
    for (const TriangleMesh& mesh : closed_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const double radius = map.view().radius;
        for (const Vec3f& p : points_near_and_far(map, mesh)) {
            Vec3f gradient;
            const double distance = signed_distance(map, p, &gradient);
            ASSERT_NEAR(length(gradient), 1, 1e-6F);
            const Vec3d foot = Vec3d(p) - Vec3d(gradient) * distance;
            const double rounding = 1e-5 * radius + 2e-7 * std::fabs(distance);
            ASSERT_LE(unsigned_distance(mesh, foot), rounding);
            // Along it the distance grows as fast as the point moves.
            const float step = 1e-2F * map.view().radius;
            if (distance < 0 || distance > 3 * radius)
                continue; // a medial axis may lie ahead; float is coarse
            ASSERT_NEAR(signed_distance(map, p + gradient * step), distance + step, 2e-3 * step);
        }
    }
}

TEST(ExactMapSignedDistance, KeepsTheSideOnTheSurface) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    int inside_count = 0;
    for (const Vec3f& p : {Vec3f{1, 0.1F, 0.2F}, Vec3f{-1, 0.1F, 0.2F}, Vec3f{0.1F, 1, 0.2F},
                           Vec3f{0.1F, -1, 0.2F}, Vec3f{0.1F, 0.2F, 1}, Vec3f{0.1F, 0.2F, -1}}) {
        Vec3f gradient;
        const float found = signed_distance(map, p, &gradient);
        EXPECT_NEAR(found, 0, 1e-6F);
        EXPECT_EQ(std::signbit(found), contains(map, p));
        inside_count += std::signbit(found) ? 1 : 0;
        EXPECT_GT(dot(gradient, p), 0.999F); // out of the solid from either side
    }
    EXPECT_EQ(inside_count, 3); // by the perturbation of ties
}

TEST(ExactMapSignedDistance, IsNanOrInfiniteForPointsThatAreNotFinite) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    Vec3f gradient{1, 2, 3};
    for (const Vec3f& p : {Vec3f{kNan, 0, 0}, Vec3f{0, kInfinity, kNan}, Vec3f{0, 0, -kNan}}) {
        EXPECT_TRUE(std::isnan(signed_distance(map, p, &gradient)));
        EXPECT_EQ(gradient, Vec3f{});
    }
    for (const Vec3f& p : {Vec3f{kInfinity, 0, 0}, Vec3f{0, -kInfinity, kInfinity}}) {
        EXPECT_EQ(signed_distance(map, p, &gradient), kInfinity);
        EXPECT_EQ(gradient, Vec3f{});
    }
    constexpr float kFar = std::numeric_limits<float>::max();
    EXPECT_EQ(signed_distance(map, {kFar, 0, 0}, &gradient), kFar);
    EXPECT_EQ(gradient, (Vec3f{1, 0, 0}));
    EXPECT_EQ(signed_distance(map, {kFar, kFar, kFar}, &gradient), kInfinity); // beyond the range of float
    EXPECT_NEAR(length(gradient), 1, 1e-6F);
}

TEST(ExactMapSignedDistance, TakesABatchOfNoPoints) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    signed_distance_batch(map, {}, {});
    signed_distance_batch(map, {}, {}, {}, 0);
}

TEST(ExactMapSignedDistance, OfAnOpenSurfaceHasTheSignOfTheGeneralisedWindingNumber) {
    TriangleMesh bowl = make_sphere(1, 24, 12);
    std::erase_if(bowl.faces, [&](const Triangle& face) { return bowl.vertices[face[0]].z > 0.4F; });
    const ExactMap map = ExactMap::build(bowl);
    std::size_t inside_count = 0, computed_count = 0;
    for (const Vec3f& p : points_near_and_far(map, bowl)) {
        const float found = signed_distance(map, p);
        const Containment side = classify(map, p);
        ASSERT_EQ(std::signbit(found), side.inside);
        const double expected = unsigned_distance(bowl, Vec3d(p));
        ASSERT_NEAR(std::fabs(found), expected, tolerance(map, expected));
        inside_count += side.inside ? 1 : 0;
        computed_count += side.computed ? 1 : 0;
        if (std::fabs(winding_number(bowl, Vec3d(p)) - 0.5) > 1e-4 && expected > 1e-5)
            ASSERT_EQ(side.inside, winding_number(bowl, Vec3d(p)) > 0.5);
    }
    EXPECT_GT(inside_count, 100U);
    EXPECT_GT(computed_count, 100U);
}
