#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

DistanceMap octahedral(const TriangleMesh& mesh, std::uint32_t divisions = 100,
                       VertexCorrection correction = VertexCorrection::None,
                       EntryFormat format = EntryFormat::Float32) {
    return DistanceMap::build(mesh, {.grid = DirectionGrid::Octahedral,
                                     .divisions = divisions,
                                     .correction = correction,
                                     .entry_format = format});
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
    // A large tilted box: only its sides, which cross coordinate planes, not its edges, are looked at.
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

TEST(OctahedralMap, HasNoSeamAtTheBordersOfOctants) {
    const DistanceMap torus = octahedral(make_torus(1, 0.4, 60, 24), 40);
    const float tiny = 1e-6F;
    test::Random random(3);
    for (int n = 0; n < 5000; ++n) {
        Vec3f a = test::in_cube(random, 1.2F);
        Vec3f b = a;
        (n % 3 == 0 ? a.x : n % 3 == 1 ? a.y : a.z) = tiny;
        (n % 3 == 0 ? b.x : n % 3 == 1 ? b.y : b.z) = -tiny;
        if (usable_sample_count(torus, a) != 3 || usable_sample_count(torus, b) != 3) continue;
        const Contact ca = contact(torus, a, 10), cb = contact(torus, b, 10);
        ASSERT_NEAR(ca.depth, cb.depth, 1e-4F) << n;
        ASSERT_NEAR(length(ca.point - cb.point), 0, 1e-4F);
    }
}

TEST(OctahedralMap, AgreesWithTheFormulasOfSphereAndTorus) {
    test::Random random(4);
    for (const EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16})
        for (const VertexCorrection correction : {VertexCorrection::None, VertexCorrection::Signed}) {
            const DistanceMap sphere = octahedral(make_sphere(1, 200, 100), 100, correction, format);
            const DistanceMap torus = octahedral(make_torus(1, 0.4, 200, 100), 100, correction, format);
            EXPECT_FALSE(torus.view().centre_inside);
            EXPECT_EQ(torus.statistics().wrong_parity_share, 0);
            for (int n = 0; n < 20'000; ++n) {
                const Vec3f p = test::in_cube(random, 1.8F);
                if (std::fabs(length(p) - 1) > 1e-3F) ASSERT_EQ(contains(sphere, p), length(p) < 1);
                const float distance = std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.4F;
                if (std::fabs(distance) > 0.03F) ASSERT_EQ(contains(torus, p), distance < 0);
            }
        }
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

TEST(OctahedralMap, AnswersAtTheCentreAlongZ) {
    const DistanceMap box = octahedral(make_box({2, 2, 2}));
    const Contact c = contact(box, box.view().centre);
    EXPECT_TRUE(c.inside);
    EXPECT_NEAR(c.depth, 1, 1e-5F);
    EXPECT_NEAR(c.point.z, 1, 1e-5F);
    EXPECT_NEAR(c.normal.z, 1, 1e-5F);
}

TEST(OctahedralMap, RebuildsAClosedSurfaceThatLooksOutwards) {
    const DistanceMap box = octahedral(make_box({2, 2, 2}), 12);
    const MapSurface surface = reconstruct_surface(box);
    const MeshReport report = inspect(surface.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(surface.mesh.faces.size(), 8U * 12 * 12);
    EXPECT_NEAR(report.signed_volume, 8, 0.2);
}

TEST(OctahedralMap, MovesVerticesOutwardsAndNeverIn) {
    const TriangleMesh mesh = make_sphere(1, 30, 15);
    const DistanceMap plain = octahedral(mesh, 16);
    const DistanceMap corrected = octahedral(mesh, 16, VertexCorrection::Signed);
    EXPECT_GT(corrected.statistics().corrected_entries, 0U);
    for (std::size_t i = 0; i < plain.view().entry_count(); ++i)
        ASSERT_GE(corrected.view().entries_float32[i], plain.view().entries_float32[i]);
    // Every vertex lies in the map's solid or on its surface.
    for (const Vec3f& v : mesh.vertices) EXPECT_TRUE(contains(corrected, v * 0.9999F));
}

TEST(OctahedralMap, RefusesDivisionsOutOfBounds) {
    for (const std::uint32_t divisions : {0U, 3U, 4097U}) {
        try {
            octahedral(make_box({1, 1, 1}), divisions);
            FAIL() << divisions;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::InvalidOptions);
        }
    }
}
