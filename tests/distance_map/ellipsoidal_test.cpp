#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace echinus;

namespace {

DistanceMap ellipsoidal(const TriangleMesh& mesh, PoleAxis axis = PoleAxis::Z,
                        EntryFormat format = EntryFormat::Float32,
                        DirectionGrid grid = DirectionGrid::Ellipsoidal) {
    return DistanceMap::build(mesh, {.grid = grid,
                                     .longitude_count = 60,
                                     .colatitude_count = 60,
                                     .correction = VertexCorrection::None,
                                     .entry_format = format,
                                     .pole_axis = axis});
}

/// An ellipsoid with these half axes.
TriangleMesh ellipsoid(const Vec3f& half, std::uint32_t fineness = 300) {
    TriangleMesh mesh = make_sphere(1, fineness, fineness / 2);
    for (Vec3f& v : mesh.vertices) v = {v.x * half.x, v.y * half.y, v.z * half.z};
    return mesh;
}

const Vec3f kHalf{0.5F, 3, 1};

} // namespace

TEST(EllipsoidalMap, ScalesTheBoxOfTheMeshToACubeWhoseEdgeIsItsShortest) {
    const DistanceMap map = ellipsoidal(make_box(Vec3d(kHalf) * 2.0));
    EXPECT_EQ(map.view().scale.x, 1);
    EXPECT_NEAR(map.view().scale.y, 0.5 / 3, 1e-5);
    EXPECT_NEAR(map.view().scale.z, 0.5, 1e-5);
    const DistanceMap cube = ellipsoidal(make_box({2, 2, 2}));
    EXPECT_EQ(cube.view().scale, (Vec3f{1, 1, 1}));
}

TEST(EllipsoidalMap, OfAnEllipsoidHasTheSameEntryEverywhere) {
    for (const PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
        const DistanceMap map = ellipsoidal(ellipsoid(kHalf), axis);
        ASSERT_EQ(map.view().entry_count(), map.view().direction_count());
        // The facets of a 300 x 150 sphere lie up to 1.1e-4 inside it in each of the two directions.
        for (const float entry : map.view().entries_float32) ASSERT_NEAR(entry, 0.5, 1.2e-4);
    }
}

TEST(EllipsoidalMap, OfAnEllipsoidHasItsSurfaceAndItsNormals) {
    test::Random random(1);
    for (const EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16}) {
        const DistanceMap map = ellipsoidal(ellipsoid(kHalf), PoleAxis::X, format);
        for (int n = 0; n < 20'000; ++n) {
            const Vec3f on_sphere = test::unit_vector(random);
            const Vec3f on_surface{on_sphere.x * kHalf.x, on_sphere.y * kHalf.y, on_sphere.z * kHalf.z};
            const Vec3f p = on_surface * test::uniform(random, 0.1F, 0.99F);
            const Contact c = contact(map, p);
            ASSERT_TRUE(c.inside);
            ASSERT_NEAR(c.depth, length(on_surface) - length(p), 3e-4F * length(on_surface));
            ASSERT_NEAR(length(c.point - on_surface), 0, 3e-4F * length(on_surface));
            const Vec3f gradient{on_sphere.x / kHalf.x, on_sphere.y / kHalf.y, on_sphere.z / kHalf.z};
            ASSERT_GT(dot(c.normal, gradient), 0.9995F * length(gradient)) << n;
        }
    }
}

TEST(EllipsoidalMap, HasNormalsThatAreTheDerivativesOfItsOwnSurface) {
    // A bumpy solid: the push-outs around a point trace the map's surface.
    TriangleMesh mesh = ellipsoid({0.5F, 2, 1}, 40);
    for (Vec3f& v : mesh.vertices) v *= 1 + 0.1F * std::sin(5 * v.y) * v.x;
    for (const PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
        const DistanceMap map = ellipsoidal(mesh, axis);
        test::Random random(2);
        int checked = 0;
        for (int n = 0; n < 5000; ++n) {
            const Vec3f p = test::in_cube(random, 0.3F);
            if (length(p) < 0.1F) continue;
            const Contact c = contact(map, p);
            const Vec3f aside = test::unit_vector(random) * (2e-3F * length(p));
            const Vec3f ahead = contact(map, p + aside).point, behind = contact(map, p - aside).point;
            const Vec3f along = ahead - behind;
            // Between two cells the surface has an edge.
            if (length(ahead + behind - c.point * 2) > 2e-3F * length(along)) continue;
            ++checked;
            ASSERT_LT(std::fabs(dot(c.normal, along)), 0.02F * length(along)) << n;
        }
        EXPECT_GT(checked, 1000);
    }
}

TEST(EllipsoidalMap, IsCloserToALongThinSolidThanASphericalOne) {
    TriangleMesh mesh = make_box({1, 10, 1}, 8);
    const Rotation lean = Rotation::about({0, 0, 1}, 0.02);
    for (Vec3f& v : mesh.vertices) v = Vec3f(lean.apply(Vec3d(v)));
    const auto worst_error = [&](DirectionGrid grid) {
        const DistanceMap map = ellipsoidal(mesh, PoleAxis::Z, EntryFormat::Float32, grid);
        test::Random random(3);
        float worst = 0;
        for (int n = 0; n < 20'000; ++n) {
            const Vec3f p = test::in_cube(random, 0.4F);
            const Vec3f in_box{p.x, 10 * p.y, p.z};
            const Contact c = contact(map, Vec3f(lean.apply(Vec3d(in_box))));
            const Vec3d end = lean.inverse().apply(Vec3d(c.point));
            // From the largest of the box's three distances, all of which are 0 or less inside.
            const double distance =
                std::max({std::fabs(end.x) - 0.5, std::fabs(end.y) - 5, std::fabs(end.z) - 0.5});
            worst = std::max(worst, static_cast<float>(std::fabs(distance)));
        }
        return worst;
    };
    EXPECT_LT(worst_error(DirectionGrid::Ellipsoidal), 0.5F * worst_error(DirectionGrid::Spherical));
}

TEST(EllipsoidalMap, OfASolidThinnerThanTheGridAllowsIsStillRight) {
    const DistanceMap needle = ellipsoidal(make_box({0.1, 10, 0.1}), PoleAxis::Y);
    EXPECT_EQ(std::min({needle.view().scale.x, needle.view().scale.y, needle.view().scale.z}), 1.0F / 64);
    EXPECT_EQ(needle.statistics().wrong_parity_share, 0);
    test::Random random(4);
    for (int n = 0; n < 10'000; ++n) {
        const Vec3f p = test::in_cube(random, 1);
        ASSERT_TRUE(contains(needle, {p.x * 0.045F, p.y * 4.5F, p.z * 0.045F}));
        ASSERT_FALSE(contains(needle, {p.x * 0.055F, p.y * 4.9F, std::copysign(0.055F, p.z)}));
    }
}
