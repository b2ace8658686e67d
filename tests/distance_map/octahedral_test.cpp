#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

DistanceMap octahedral(const TriangleMesh& mesh, std::uint32_t divisions = 100,
                       VertexCorrection correction = VertexCorrection::None) {
    return DistanceMap::build(
        mesh, {.grid = DirectionGrid::Octahedral, .divisions = divisions, .correction = correction});
}

std::array<float, 3> sorted_sides(const Vec3f& p) {
    std::array<float, 3> sides{std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
    std::sort(sides.begin(), sides.end());
    return sides;
}

/// Does the ray through p leave a box of sides 2 within `cells` cells of one of its edges?
bool near_an_edge(const Vec3f& p, float cells, std::uint32_t divisions) {
    const auto sides = sorted_sides(p);
    const float l1 = sides[0] + sides[1] + sides[2];
    return (sides[2] - sides[1]) / l1 < 2 * cells / static_cast<float>(divisions);
}

} // namespace

TEST(OctahedralMap, ReproducesFlatFacesUpToRounding) {
    test::Random random(1);
    for (const std::uint32_t divisions : {8U, 100U}) {
        const DistanceMap box = octahedral(make_box({2, 2, 2}), divisions);
        for (int n = 0; n < 20'000; ++n) {
            const Vec3f p = test::in_cube(random, 1);
            if (near_an_edge(p, 2, divisions)) continue;
            const Contact c = contact(box, p);
            ASSERT_TRUE(c.inside);
            const auto end = sorted_sides(c.point);
            ASSERT_NEAR(end[2], 1, 4e-6F);
            const auto normal = sorted_sides(c.normal);
            ASSERT_NEAR(normal[2], 1, 1e-6F);
            ASSERT_LT(normal[1], 2e-3F);
            ASSERT_GT(dot(c.normal, p), 0);
        }
    }
}

TEST(OctahedralMap, ReproducesASlantingFaceAcrossTheEdgesOfTheOctahedron) {
    // A large tilted box: only its sides, which cross coordinate planes, are tested, not its edges.
    const Rotation tilt = Rotation::about({1, 2, 3}, 0.7);
    TriangleMesh box = make_box({2, 2, 2});
    for (Vec3f& v : box.vertices) v = Vec3f(tilt.apply(Vec3d(v)));
    const DistanceMap map = octahedral(box);
    test::Random random(2);
    int checked = 0;
    for (int n = 0; n < 40'000; ++n) {
        const Vec3f in_box = test::in_cube(random, 1);
        const auto sides = sorted_sides(in_box);
        if (sides[1] > 0.9F * sides[2]) continue;
        Vec3f p = Vec3f(tilt.apply(Vec3d(in_box)));
        if (n % 3 == 0) p.z *= 1e-3F; // about the octahedron's edges
        if (n % 3 == 1) p.x *= 1e-3F;
        const auto flattened = sorted_sides(Vec3f(tilt.inverse().apply(Vec3d(p))));
        if (flattened[1] > 0.9F * flattened[2]) continue;
        ++checked;
        const Contact c = contact(map, p, 10);
        const auto end = sorted_sides(Vec3f(tilt.inverse().apply(Vec3d(c.point))));
        ASSERT_NEAR(end[2], 1, 1e-5F);
        const auto normal = sorted_sides(Vec3f(tilt.inverse().apply(Vec3d(c.normal))));
        ASSERT_NEAR(normal[2], 1, 1e-5F);
    }
    EXPECT_GT(checked, 1000);
}

TEST(OctahedralMap, IsNoWorseThanASphericalOneOfAsManyBytes) {
    // A bumpy solid: flat faces, edges, and silhouettes seen from its centre.
    TriangleMesh mesh = make_torus(1, 0.5, 14, 9);
    const Rotation tilt = Rotation::about({3, 1, 2}, 1);
    for (Vec3f& v : mesh.vertices) v = Vec3f(tilt.apply(Vec3d(v)));
    const ExactMap judge = ExactMap::build(mesh);
    const DistanceMap spherical = DistanceMap::build(mesh, {.longitude_count = 81, .colatitude_count = 81});
    const DistanceMap other = octahedral(mesh, 38, VertexCorrection::Signed);
    ASSERT_LE(other.view().byte_count(), spherical.view().byte_count());
    test::Random random(5);
    int wrong_spherical = 0, wrong_octahedral = 0;
    for (int n = 0; n < 200'000; ++n) {
        const Vec3f p = test::in_sphere(random, judge.view().radius);
        const bool inside = contains(judge, p);
        wrong_spherical += contains(spherical, p) != inside ? 1 : 0;
        wrong_octahedral += contains(other, p) != inside ? 1 : 0;
    }
    EXPECT_GT(wrong_spherical, 0);
    EXPECT_LE(wrong_octahedral, wrong_spherical);
}
