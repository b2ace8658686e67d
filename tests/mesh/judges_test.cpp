#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

using namespace echinus;

namespace {

Vec3d random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> coordinate(-size, size);
    return {coordinate(random), coordinate(random), coordinate(random)};
}

/// Distance from a point to the surface of the box [-half, half].
double box_distance(const Vec3d& p, const Vec3d& half) {
    const Vec3d beyond{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3d outside{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
    const double inside = std::min(0.0, std::max({beyond.x, beyond.y, beyond.z}));
    return length(outside) - inside;
}

} // namespace

TEST(WindingNumber, IsOneInsideABoxAndZeroOutside) {
    std::mt19937 random(1);
    const TriangleMesh box = make_box({1, 2, 3}, 2);
    for (int i = 0; i < 500; ++i) {
        const Vec3d p = random_point(random, 2);
        const bool inside = std::abs(p.x) < 0.5 && std::abs(p.y) < 1 && std::abs(p.z) < 1.5;
        ASSERT_NEAR(winding_number(box, p), inside ? 1 : 0, 1e-12);
    }
}

TEST(WindingNumber, OfOneSideOfACubeSeenFromItsCentreIsASixth) {
    const TriangleMesh side{{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_NEAR(winding_number(side, {0, 0, 0}), 1.0 / 6, 1e-15);
    EXPECT_NEAR(winding_number(side, {0, 0, 2}), -1.0 / 6, 1e-15);
}

TEST(WindingNumber, OfTwoOverlappingBoxesIsTwoWhereTheyOverlap) {
    TriangleMesh both = make_box({2, 2, 2});
    const TriangleMesh other = both;
    for (const Vec3f& p : other.vertices) both.vertices.push_back(p + Vec3f{1, 0, 0});
    for (const Triangle& f : other.faces) both.faces.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
    EXPECT_NEAR(winding_number(both, {0.5, 0.1, 0.2}), 2, 1e-12);
    EXPECT_NEAR(winding_number(both, {-0.5, 0.1, 0.2}), 1, 1e-12);
}

TEST(WindingNumber, IsFiniteOnVerticesAndNotANumberForNaN) {
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_TRUE(std::isfinite(winding_number(box, Vec3d(box.vertices[0]))));
    EXPECT_TRUE(std::isnan(winding_number(box, {std::numeric_limits<double>::quiet_NaN(), 0, 0})));
}

TEST(UnsignedDistance, AgreesWithTheFormulaOfABox) {
    std::mt19937 random(2);
    const TriangleMesh box = make_box({1, 2, 3}, 3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d p = random_point(random, 2);
        ASSERT_NEAR(unsigned_distance(box, p), box_distance(p, {0.5, 1, 1.5}), 1e-14);
    }
}

TEST(UnsignedDistance, OfFacesWithoutAreaIsThatOfTheirEdges) {
    const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(unsigned_distance(needle, {1.5, 2, 0}), 2);
    EXPECT_EQ(unsigned_distance(needle, {3, 0, 0}), 1);
    const TriangleMesh dot{{{1, 1, 1}}, {{0, 0, 0}}};
    EXPECT_EQ(unsigned_distance(dot, {1, 1, 3}), 2);
}

TEST(UnsignedDistance, IsInfiniteWithoutFacesAndForNaN) {
    EXPECT_EQ(unsigned_distance({}, {0, 0, 0}), std::numeric_limits<double>::infinity());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(unsigned_distance(make_box({1, 1, 1}), {0, nan, 0}), std::numeric_limits<double>::infinity());
}
