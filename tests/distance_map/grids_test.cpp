#include "support/distance_maps.hpp"
#include "support/expectations.hpp"
#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace echinus;
using test::options_of;

// Properties of maps on every grid of directions.

namespace {

class EveryMap : public testing::TestWithParam<DirectionGrid> {
  protected:
    DistanceMap build(const TriangleMesh& mesh, std::uint32_t resolution = 100,
                      VertexCorrection correction = VertexCorrection::None,
                      EntryFormat format = EntryFormat::Float32) const {
        return DistanceMap::build(mesh, options_of(GetParam(), resolution, correction, format));
    }
};

INSTANTIATE_TEST_SUITE_P(Grids, EveryMap, testing::ValuesIn(test::kEveryGrid),
                         [](const auto& param_info) { return test::name_of(param_info.param); });

} // namespace

TEST_P(EveryMap, AgreesWithTheFormulasOfSphereAndTorus) {
    test::Random random(4);
    for (const EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16})
        for (const VertexCorrection correction : {VertexCorrection::None, VertexCorrection::Signed}) {
            const DistanceMap sphere = build(make_sphere(1, 200, 100), 100, correction, format);
            const DistanceMap torus = build(make_torus(1, 0.4, 200, 100), 100, correction, format);
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

TEST_P(EveryMap, HasTheDepthAndTheNormalOfASlantingBox) {
    const Rotation tilt = Rotation::about({1, 2, 3}, 0.7);
    const Vec3d size{1, 2, 3}; // its box, and with it an ellipsoid, is no cube either
    TriangleMesh box = make_box(size * 2.0);
    for (Vec3f& v : box.vertices) v = Vec3f(tilt.apply(Vec3d(v)));
    const DistanceMap map = build(box);
    test::Random random(2);
    int checked = 0;
    for (int n = 0; n < 40'000; ++n) {
        const Vec3d in_unit_box(test::in_cube(random, 1));
        const Vec3d in_box{in_unit_box.x * size.x, in_unit_box.y * size.y, in_unit_box.z * size.z};
        std::array<double, 3> sides{std::fabs(in_unit_box.x), std::fabs(in_unit_box.y),
                                    std::fabs(in_unit_box.z)};
        std::sort(sides.begin(), sides.end());
        if (sides[1] > 0.85 * sides[2] || sides[2] < 1e-3) continue; // the box's edges
        ++checked;
        const Contact c = contact(map, Vec3f(tilt.apply(in_box)));
        ASSERT_TRUE(c.inside);
        // Along the ray the side is farther than straight ahead.
        ASSERT_NEAR(c.depth, length(in_box) * (1 / sides[2] - 1), 6e-3);
        const Vec3d normal = tilt.inverse().apply(Vec3d(c.normal));
        ASSERT_GT(std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)}), 0.998) << n;
        ASSERT_GT(dot(normal, in_box), 0);
    }
    EXPECT_GT(checked, 10'000);
}

TEST_P(EveryMap, HasNoSeamAlongPlanesOfSymmetry) {
    const DistanceMap torus = build(make_torus(1, 0.4, 60, 24), 40);
    const float tiny = 1e-6F;
    test::Random random(3);
    const auto expect_no_seam = [&](const Vec3f& a, const Vec3f& b) {
        if (usable_sample_count(torus, a) < 3 || usable_sample_count(torus, b) < 3) return;
        if (usable_sample_count(torus, a) != usable_sample_count(torus, b)) return;
        const Contact ca = contact(torus, a, 10), cb = contact(torus, b, 10);
        EXPECT_NEAR(ca.depth, cb.depth, 1e-4F);
        EXPECT_NEAR(length(ca.point - cb.point), 0, 1e-4F);
    };
    for (int n = 0; n < 5000; ++n) {
        const Vec3f p = test::in_cube(random, 1.2F);
        expect_no_seam({tiny, p.y, p.z}, {-tiny, p.y, p.z});
        expect_no_seam({p.x, tiny, p.z}, {p.x, -tiny, p.z});
        expect_no_seam({p.x, p.y, tiny}, {p.x, p.y, -tiny});
        expect_no_seam({p.x, p.x * (1 + tiny), p.z}, {p.x, p.x * (1 - tiny), p.z});
    }
}

TEST_P(EveryMap, AnswersAtTheCentreAlongZ) {
    const DistanceMap box = build(make_box({2, 2, 2}));
    const Contact c = contact(box, box.view().centre);
    EXPECT_TRUE(c.inside);
    // Interpolation bends a flat side over the half cell beside its foot, which is 0.01 rad.
    EXPECT_NEAR(c.depth, 1, 2e-4F);
    EXPECT_NEAR(c.point.z, 1, 2e-4F);
    EXPECT_NEAR(c.normal.z, 1, 2e-4F);
}

TEST_P(EveryMap, RebuildsAClosedSurfaceThatLooksOutwards) {
    const DistanceMap box = build(make_box({2, 3, 4}), 20);
    const MeshReport report = inspect(reconstruct_surface(box).mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(report.signed_volume, 24, 1);
}

TEST_P(EveryMap, MovesVerticesOutwardsAndNeverIn) {
    TriangleMesh mesh = make_sphere(1, 30, 15);
    for (Vec3f& v : mesh.vertices) v.x *= 1.5F;
    const DistanceMap plain = build(mesh, 20);
    const DistanceMap corrected = build(mesh, 20, VertexCorrection::Signed);
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

TEST_P(EveryMap, RefusesCountsOutOfBounds) {
    for (const std::uint32_t count : {0U, 3U, 8193U})
        test::expect_error(ErrorCode::InvalidOptions, "", [&] {
            DistanceMap::build(make_box({1, 1, 1}),
                               {.grid = GetParam(), .longitude_count = count, .divisions = count});
        });
}

TEST_P(EveryMap, HasASourceHashOfItsOwn) {
    const TriangleMesh box = make_box({1, 1, 1});
    DistanceMapOptions options = options_of(GetParam(), 10);
    const std::uint64_t hash = DistanceMap::build(box, options).source_hash();
    for (const DirectionGrid other : test::kEveryGrid)
        if (other != GetParam())
            EXPECT_NE(DistanceMap::build(box, options_of(other, 10)).source_hash(), hash);
    options.centre = CentreChoice::Search;
    EXPECT_NE(DistanceMap::build(box, options).source_hash(), hash);
}

TEST_P(EveryMap, KeepsEveryVertexInItsSphereWhateverTheCentre) {
    for (const CentreChoice choice : {CentreChoice::BoundingSphere, CentreChoice::Search}) {
        TriangleMesh mesh = make_torus(1, 0.3, 24, 12);
        for (Vec3f& v : mesh.vertices) v = {v.x, v.y + 0.3F * v.x * v.x, 3 * v.z};
        DistanceMapOptions options = options_of(GetParam(), 20);
        options.centre = choice;
        const DistanceMap map = DistanceMap::build(mesh, options);
        for (const Vec3f& v : mesh.vertices)
            EXPECT_LE(length(Vec3d(v) - Vec3d(map.view().centre)), static_cast<double>(map.view().radius));
        EXPECT_EQ(map.statistics().wrong_parity_share, 0);
    }
}

TEST_P(EveryMap, IsWrongLessOftenInAndAroundAnLShapedSolidOnceItsCentreIsSearched) {
    const TriangleMesh mesh = [] {
        constexpr float kOutline[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
        TriangleMesh l;
        for (const float z : {0.0F, 1.0F})
            for (const auto& [x, y] : kOutline) l.vertices.push_back({x, y, z});
        for (const Triangle& face : {Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
            l.faces.push_back({face[0], face[2], face[1]});
            l.faces.push_back({face[0] + 6, face[1] + 6, face[2] + 6});
        }
        for (std::uint32_t i = 0; i < 6; ++i) {
            const std::uint32_t next = (i + 1) % 6;
            l.faces.push_back({i, next, next + 6});
            l.faces.push_back({i, next + 6, i + 6});
        }
        return l;
    }();
    ASSERT_TRUE(inspect(mesh).closed);
    DistanceMapOptions options = options_of(GetParam(), 40);
    const auto count_wrong = [&] {
        const DistanceMap map = DistanceMap::build(mesh, options);
        test::Random random(6);
        int wrong = 0;
        for (int n = 0; n < 100'000; ++n) {
            const Vec3f p = test::in_cube(random, 1.6F) + Vec3f{1.5F, 1.5F, 0.5F};
            const bool in_both = p.x > 0 && p.y > 0 && p.z > 0 && p.x < 3 && p.y < 3 && p.z < 1;
            const bool inside = in_both && (p.x < 1 || p.y < 1);
            wrong += contains(map, p) != inside ? 1 : 0;
        }
        return wrong;
    };
    const int before = count_wrong();
    options.centre = CentreChoice::Search;
    EXPECT_LT(count_wrong(), before);
}

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
