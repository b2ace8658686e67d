// The judge of intersections agrees with CGAL's exact predicates.

#include "judges/intersection_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;
using namespace echinus::test;

namespace {

using FloatCorners = std::array<Vec3f, 3>;

/// A point of a triangle or near it: where floats can hold it on an edge or in the plane, else rounded.
Vec3f point_of(Random& random, const FloatCorners& t) {
    const double u = std::uniform_int_distribution<int>(-2, 10)(random) / 8.0;
    const double v = std::uniform_int_distribution<int>(-2, 10)(random) / 8.0;
    const Vec3d a(t[0]);
    return Vec3f(a + u * (Vec3d(t[1]) - a) + v * (Vec3d(t[2]) - a));
}

/// Moved by at most one step of the floats along each axis.
Vec3f nudged(Random& random, const Vec3f& p) {
    const auto nudge = [&](float x) {
        const float towards[] = {-1e30F, x, 1e30F};
        return std::nextafter(x, towards[std::uniform_int_distribution<int>(0, 2)(random)]);
    };
    const float x = nudge(p.x), y = nudge(p.y);
    return {x, y, nudge(p.z)};
}

/// A mesh whose vertices all moved by up to `size` in every direction.
TriangleMesh crumpled(TriangleMesh mesh, Random& random, float size) {
    for (Vec3f& vertex : mesh.vertices) vertex += in_cube(random, size);
    return mesh;
}

} // namespace

TEST(IntersectionsOracle, TrianglesOfWholeNumbersMeetAsCgalSays) {
    Random random(1);
    for (const int half_width : {1, 2, 4, 1000}) {
        for (int i = 0; i < 20'000; ++i) {
            FloatCorners a, b;
            for (Vec3f& p : a) p = whole_point(random, half_width);
            for (Vec3f& p : b) p = whole_point(random, half_width);
            ASSERT_EQ(triangles_intersect(a, b), triangles_intersect_by_cgal(a, b))
                << i << ", " << half_width;
        }
    }
}

TEST(IntersectionsOracle, TrianglesThatNearlyTouchMeetAsCgalSays) {
    Random random(2);
    int meeting = 0;
    constexpr int kCount = 40'000;
    for (int i = 0; i < kCount; ++i) {
        FloatCorners a{in_cube(random, 1), in_cube(random, 1), in_cube(random, 1)};
        if (i % 8 == 0) a[2] = point_of(random, {a[0], a[1], a[1]}); // a sliver, up to rounding
        FloatCorners b{nudged(random, point_of(random, a)), in_cube(random, 1), in_cube(random, 1)};
        if (i % 2 == 0) b[1] = nudged(random, point_of(random, a));
        if (i % 4 == 0) b[2] = nudged(random, point_of(random, a));
        const bool expected = triangles_intersect_by_cgal(a, b);
        ASSERT_EQ(triangles_intersect(a, b), expected) << i;
        meeting += expected;
    }
    EXPECT_GT(meeting, kCount / 5);
    EXPECT_LT(meeting, kCount * 4 / 5);
}

TEST(IntersectionsOracle, PairsOfTwoMeshesAreThoseOfCgal) {
    Random random(3);
    for (const auto& [name, mesh] : generated_meshes())
        for (const auto& [other_name, other] : generated_meshes()) {
            const TriangleMesh moved = crumpled(other, random, 0.05F);
            ASSERT_EQ(intersecting_pairs(mesh, moved), intersecting_pairs_by_cgal(mesh, moved))
                << name << " and " << other_name;
        }
}

TEST(IntersectionsOracle, PairsOfAMeshWithItselfAreThoseOfCgal) {
    Random random(4);
    std::size_t found = 0;
    for (const auto& [name, mesh] : generated_meshes())
        for (const float size : {0.0F, 0.01F, 0.2F}) {
            const TriangleMesh moved = crumpled(mesh, random, size);
            const auto pairs = self_intersecting_pairs(moved);
            ASSERT_EQ(pairs, self_intersecting_pairs_by_cgal(moved)) << name << ", " << size;
            found += pairs.size();
        }
    EXPECT_GT(found, 1000U);
    for (int i = 0; i < 200; ++i) {
        const TriangleMesh mesh = random_soup(random, 10, 20, i % 4 + 1);
        ASSERT_EQ(self_intersecting_pairs(mesh), self_intersecting_pairs_by_cgal(mesh)) << i;
    }
}
