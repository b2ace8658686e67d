#include "support/expectations.hpp"
#include "support/random_points.hpp"
#include "support/soft_bodies.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr std::uint32_t kCount = 5;

std::vector<Vec3f> random_points(std::size_t count, float low, float high) {
    Random random(3);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(uniform(random, low, high), uniform(random, low, high),
                            uniform(random, low, high));
    return points;
}

/// Stretches, shears, turns and moves.
Vec3d affine(const Vec3f& p) {
    const Vec3d q(p);
    return {1.5 * q.x + 0.3 * q.y - 0.2 * q.z + 7, -0.4 * q.x + 0.9 * q.y + 0.1 * q.z - 3,
            0.2 * q.x - 0.7 * q.y + 1.2 * q.z + 1};
}

double greatest_error_of_affine_motion(const std::vector<Vec3f>& points) {
    const TetrahedralMesh brick = make_brick(kCount);
    std::vector<Vec3f> moved;
    for (const Vec3f& p : brick.vertices) moved.emplace_back(affine(p));
    std::vector<Vec3f> carried(points.size());
    carry(embed(brick, points), moved, carried);
    double greatest = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        greatest = std::max(greatest, length(Vec3d(carried[i]) - affine(points[i])));
    return greatest;
}

} // namespace

TEST(Embed, FindsTheTetrahedronThatHoldsAPoint) {
    const TetrahedralMesh brick = make_brick(kCount);
    const std::vector<Vec3f> points = random_points(2000, 0, kCount);
    const Embedding embedding = embed(brick, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const EmbeddedPoint& point = embedding[i];
        EXPECT_EQ(point.vertices, brick.tetrahedra[point.tetrahedron]);
        for (const float weight : point.weights) EXPECT_GE(weight, -1e-6F);
        EXPECT_NEAR(std::accumulate(point.weights.begin(), point.weights.end(), 0.0), 1, 1e-6);
        Vec3d sum;
        for (std::size_t k = 0; k < 4; ++k)
            sum += Vec3d(brick.vertices[point.vertices[k]]) * double{point.weights[k]};
        EXPECT_LT(length(sum - Vec3d(points[i])), 1e-5);
    }
}

TEST(Embed, TakesTheNearestTetrahedronOutside) {
    const TetrahedralMesh brick = make_brick(kCount);
    const TriangleMesh surface = boundary(brick);
    for (const Vec3f& point : random_points(300, -2, kCount + 2)) {
        const EmbeddedPoint embedded = embed(brick, std::vector<Vec3f>{point})[0];
        const TetrahedralMesh one{brick.vertices, {embedded.vertices}};
        const bool is_inside = winding_number(surface, Vec3d(point)) > 0.5;
        const double expected = is_inside ? 0 : unsigned_distance(surface, Vec3d(point));
        const bool is_inside_one = winding_number(boundary(one), Vec3d(point)) > 0.5 - 1e-9;
        const double distance = is_inside_one ? 0 : unsigned_distance(boundary(one), Vec3d(point));
        EXPECT_NEAR(distance, expected, 1e-6);
    }
}

TEST(Embed, GivesAPointOfSeveralTheSmallestNumber) {
    const TetrahedralMesh brick = make_brick(2);
    EXPECT_EQ(embed(brick, std::vector<Vec3f>{{1, 1, 1}})[0].tetrahedron, 0U); // a corner of all eight cubes
}

TEST(Embed, FollowsAnAffineMotionUpToRounding) {
    EXPECT_LT(greatest_error_of_affine_motion(random_points(5000, 0, kCount)), 3e-6);
    EXPECT_LT(greatest_error_of_affine_motion(random_points(5000, -1, kCount + 1)), 6e-6);
}

TEST(Embed, FollowsATranslationWithoutDrift) {
    const TetrahedralMesh brick = make_brick(kCount);
    const std::vector<Vec3f> points = random_points(1000, 0, kCount);
    std::vector<Vec3f> here(points.size()), there(points.size());
    const Embedding embedding = embed(brick, points);
    carry(embedding, brick.vertices, here);
    std::vector<Vec3f> moved = brick.vertices;
    for (Vec3f& p : moved) p += Vec3f{1024, 0, 0}; // whole numbers: exact
    carry(embedding, moved, there, 3);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(there[i].x - 1024, here[i].x, 1.0 / 8192); // half a unit in the last place
        EXPECT_EQ(there[i].y, here[i].y);
        EXPECT_EQ(there[i].z, here[i].z);
    }
}

TEST(Embed, DoesNotDependOnTheNumberOfThreads) {
    const TetrahedralMesh brick = make_brick(kCount);
    const std::vector<Vec3f> points = random_points(20'000, -1, kCount + 1);
    const Embedding one = embed(brick, points, 1), many = embed(brick, points, 4);
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(one[i].tetrahedron, many[i].tetrahedron);
        ASSERT_EQ(one[i].weights, many[i].weights);
    }
}

TEST(Embed, RefusesPointsThatAreNotFinite) {
    expect_error(ErrorCode::InvalidMesh, "point 1 to be embedded is not finite", [] {
        embed(make_brick(1), std::vector<Vec3f>{{0, 0, 0}, {0, std::numeric_limits<float>::infinity(), 0}});
    });
}
