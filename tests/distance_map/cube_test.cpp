#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

DistanceMap cube(const TriangleMesh& mesh, std::uint32_t divisions = 81,
                 VertexCorrection correction = VertexCorrection::None,
                 EntryFormat format = EntryFormat::Float32) {
    return DistanceMap::build(mesh, {.grid = DirectionGrid::Cube,
                                     .divisions = divisions,
                                     .correction = correction,
                                     .entry_format = format});
}

} // namespace

TEST(CubeMap, AgreesWithTheFormulasOfSphereAndTorus) {
    test::Random random(4);
    for (const EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16})
        for (const VertexCorrection correction : {VertexCorrection::None, VertexCorrection::Signed}) {
            const DistanceMap sphere = cube(make_sphere(1, 200, 100), 81, correction, format);
            const DistanceMap torus = cube(make_torus(1, 0.4, 200, 100), 81, correction, format);
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

TEST(CubeMap, HasTheDepthAndTheNormalOfASlantingBox) {
    const Rotation tilt = Rotation::about({1, 2, 3}, 0.7);
    TriangleMesh box = make_box({2, 2, 2});
    for (Vec3f& v : box.vertices) v = Vec3f(tilt.apply(Vec3d(v)));
    const DistanceMap map = cube(box);
    test::Random random(2);
    int checked = 0;
    for (int n = 0; n < 20'000; ++n) {
        const Vec3d in_box(test::in_cube(random, 1));
        const Contact c = contact(map, Vec3f(tilt.apply(in_box)));
        std::array<double, 3> sides{std::fabs(in_box.x), std::fabs(in_box.y), std::fabs(in_box.z)};
        std::sort(sides.begin(), sides.end());
        if (sides[1] > 0.9 * sides[2] || sides[2] < 1e-3) continue; // the box's edges
        ++checked;
        ASSERT_TRUE(c.inside);
        // Along the ray the side is farther than straight ahead.
        ASSERT_NEAR(c.depth, length(in_box) * (1 / sides[2] - 1), 1e-3);
        const Vec3d normal = tilt.inverse().apply(Vec3d(c.normal));
        ASSERT_GT(std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)}), 0.9995) << n;
        ASSERT_GT(dot(normal, in_box), 0);
    }
    EXPECT_GT(checked, 10'000);
}

TEST(CubeMap, HasNoSeamAlongTheEdgesOfTheCube) {
    const DistanceMap torus = cube(make_torus(1, 0.4, 60, 24), 40);
    test::Random random(3);
    for (int n = 0; n < 5000; ++n) {
        const Vec3f p = test::in_cube(random, 1.2F);
        const Vec3f a{p.x, p.x * (1 + 1e-6F), p.z}, b{p.x, p.x * (1 - 1e-6F), p.z};
        if (usable_sample_count(torus, a) != 4 || usable_sample_count(torus, b) != 4) continue;
        const Contact ca = contact(torus, a, 10), cb = contact(torus, b, 10);
        ASSERT_NEAR(ca.depth, cb.depth, 1e-4F) << n;
        ASSERT_NEAR(length(ca.point - cb.point), 0, 1e-4F);
    }
}

TEST(CubeMap, AnswersAtTheCentreAlongZ) {
    const DistanceMap box = cube(make_box({2, 2, 2}), 80);
    const Contact c = contact(box, box.view().centre);
    EXPECT_TRUE(c.inside);
    EXPECT_NEAR(c.depth, 1, 1e-5F);
    EXPECT_NEAR(c.point.z, 1, 1e-5F);
    // The distance to a flat side is bent over the half cell beside its foot: half a cell is 0.01 rad.
    EXPECT_NEAR(c.normal.z, 1, 2e-4F);
}

TEST(CubeMap, RebuildsAClosedSurfaceThatLooksOutwards) {
    const DistanceMap box = cube(make_box({2, 2, 2}), 12);
    const MapSurface surface = reconstruct_surface(box);
    const MeshReport report = inspect(surface.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(surface.mesh.faces.size(), 6U * 12 * 12 * 2);
    EXPECT_NEAR(report.signed_volume, 8, 0.05);
}

TEST(CubeMap, MovesVerticesOutwardsAndNeverIn) {
    TriangleMesh mesh = make_sphere(1, 30, 15);
    for (Vec3f& v : mesh.vertices) v.x *= 1.5F;
    const DistanceMap plain = cube(mesh, 16);
    const DistanceMap corrected = cube(mesh, 16, VertexCorrection::Signed);
    EXPECT_GT(corrected.statistics().corrected_entries, 0U);
    for (std::size_t i = 0; i < plain.view().entry_count(); ++i)
        ASSERT_GE(corrected.view().entries_float32[i], plain.view().entries_float32[i]);
    int checked = 0;
    for (const Vec3f& v : mesh.vertices) {
        if (length(v) > 0.9F * corrected.view().radius) continue; // cut short at the bounding sphere
        EXPECT_TRUE(contains(corrected, v * 0.9999F));
        ++checked;
    }
    EXPECT_GT(checked, 100);
}

TEST(CubeMap, RefusesDivisionsOutOfBounds) {
    for (const std::uint32_t divisions : {0U, 3U, 4097U}) {
        try {
            cube(make_box({1, 1, 1}), divisions);
            FAIL() << divisions;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::InvalidOptions);
        }
    }
}
