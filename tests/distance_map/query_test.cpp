#include "support/distance_maps.hpp"
#include "support/random_points.hpp"

#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace echinus;

namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kFarAway = std::numeric_limits<float>::infinity();

float box_side(const Vec3f& p) {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// Signed distance to the torus of radii 1 and 0.4, negative inside.
float torus_distance(const Vec3f& p) {
    return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.4F;
}

bool same(const Contact& a, const Contact& b) {
    return a.inside == b.inside && a.depth == b.depth && a.point == b.point && a.normal == b.normal &&
           a.face == b.face;
}

} // namespace

TEST(DistanceMapQuery, AgreesWithTheFormulasOfSphereBoxAndTorus) {
    test::Random random(1);
    const DistanceMap sphere = DistanceMap::build(make_sphere(1, 200, 100));
    const DistanceMap box = DistanceMap::build(make_box({2, 2, 2}));
    const DistanceMap torus = DistanceMap::build(make_torus(1, 0.4, 200, 100));
    for (int n = 0; n < 100'000; ++n) {
        const Vec3f p = test::in_cube(random, 1.8F);
        if (std::fabs(length(p) - 1) > 1e-3F) ASSERT_EQ(contains(sphere, p), length(p) < 1);
        // Linear interpolation in a cell of 0.03 rad bends a flat side by up to 2e-3, and rounds its edges.
        if (std::fabs(box_side(p) - 1) > 0.03F) ASSERT_EQ(contains(box, p), box_side(p) < 1);
        // Where rays graze the tube, a neighbouring sample misses it.
        if (std::fabs(torus_distance(p)) > 0.02F) ASSERT_EQ(contains(torus, p), torus_distance(p) < 0);
    }
}

TEST(DistanceMapQuery, PushesRadiallyOntoTheSurface) {
    test::Random random(2);
    const DistanceMap torus =
        DistanceMap::build(make_torus(1, 0.4, 200, 100), {.correction = VertexCorrection::None});
    int checked = 0;
    for (int n = 0; n < 50'000; ++n) {
        const Vec3f p = test::in_cube(random, 1.4F);
        const Contact c = contact(torus, p);
        ASSERT_EQ(c.inside, contains(torus, p));
        ASSERT_EQ(c.found(), c.inside);
        if (!c.inside || torus_distance(p) > -0.05F) continue;
        ++checked;
        ASSERT_NEAR(torus_distance(c.point), 0, 0.02F);
        ASSERT_NEAR(length(c.point - p), c.depth, 1e-5F);
        ASSERT_NEAR(length(cross(c.point - p, p)), 0, 1e-5F); // along the ray
        ASSERT_GT(dot(c.normal, c.point - p), 0);
        ASSERT_NEAR(length(c.normal), 1, 1e-5F);
        ASSERT_EQ(c.face, kNoIndex);
    }
    EXPECT_GT(checked, 1000);
}

TEST(DistanceMapQuery, GivesTheNormalOfTheSurfaceNotOfTheRay) {
    test::Random random(3);
    for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
        const DistanceMap box = DistanceMap::build(make_box({2, 2, 2}),
                                                   {.correction = VertexCorrection::None, .pole_axis = axis});
        for (int n = 0; n < 20'000; ++n) {
            const Vec3f p = test::in_cube(random, 1);
            std::array<float, 3> sides{std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)};
            std::sort(sides.begin(), sides.end());
            if (sides[1] > 0.9F * sides[2]) continue; // the ray leaves near an edge of the box
            const Vec3f normal = contact(box, p).normal;
            ASSERT_GT(std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)}), 0.99F);
            ASSERT_GT(dot(normal, p), 0);
        }
    }
}

TEST(DistanceMapQuery, ReportsParticlesOutsideWithinTheMarginWithNegativeDepth) {
    const DistanceMap sphere =
        DistanceMap::build(make_sphere(1, 200, 100), {.correction = VertexCorrection::None});
    const Contact near = contact(sphere, {0, 0.6F, 0.8008F}, 0.01F); // 0.00064 outside
    EXPECT_FALSE(near.inside);
    EXPECT_TRUE(near.found());
    EXPECT_NEAR(near.depth, -0.00064F, 1e-3F);
    EXPECT_LT(near.depth, 0);
    EXPECT_NEAR(length(near.point), 1, 1e-3F);

    const Vec3f far{0, 0, 1.02F};
    const Contact none = contact(sphere, far, 0.01F);
    EXPECT_FALSE(none.found());
    EXPECT_EQ(none.depth, 0);
    EXPECT_EQ(none.normal, Vec3f{});
    EXPECT_EQ(none.point, far);
    EXPECT_TRUE(contact(sphere, far, 0.03F).found());
    EXPECT_FALSE(contact(sphere, far, kNoNumber).found());
    EXPECT_FALSE(contact(sphere, far, -1).found());
    EXPECT_TRUE(contact(sphere, far, kFarAway).found());
}

TEST(DistanceMapQuery, TreatsNaNAndInfinityAsOutside) {
    const DistanceMap box = DistanceMap::build(make_box({2, 2, 2}));
    for (float bad : {kNoNumber, kFarAway, -kFarAway, std::numeric_limits<float>::max()})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}, Vec3f{bad, bad, bad}}) {
            EXPECT_FALSE(contains(box, p));
            for (float margin : {0.0F, 1.0F, kFarAway}) EXPECT_FALSE(contact(box, p, margin).found());
            EXPECT_EQ(usable_sample_count(box, p), 0);
        }
}

TEST(DistanceMapQuery, AnswersAtTheCentre) {
    const DistanceMap box = DistanceMap::build(make_box({2, 2, 2}));
    const Vec3f centre = box.view().centre;
    EXPECT_TRUE(contains(box, centre));
    const Contact c = contact(box, centre);
    EXPECT_NEAR(c.depth, 1, 1e-3F);
    EXPECT_NEAR(c.point.z, 1, 1e-3F);
    EXPECT_NEAR(c.normal.z, 1, 1e-3F);

    const DistanceMap torus = DistanceMap::build(make_torus(1, 0.4, 60, 24));
    EXPECT_FALSE(contains(torus, torus.view().centre));
    EXPECT_FALSE(contact(torus, torus.view().centre).found());
}

TEST(DistanceMapQuery, IsContinuousAcrossSeamAndPoles) {
    const DistanceMap box = DistanceMap::build(make_box({2, 2, 2}), {.correction = VertexCorrection::None});
    const float tiny = 1e-6F;
    const auto depth = [&](const Vec3f& p) { return contact(box, p).depth; };
    EXPECT_NEAR(depth({0.5F, tiny, 0.1F}), depth({0.5F, -tiny, 0.1F}), 1e-5F);
    EXPECT_NEAR(depth({-0.5F, tiny, 0.1F}), depth({-0.5F, -tiny, 0.1F}), 1e-5F);
    for (float z : {0.5F, -0.5F}) {
        for (float x : {-tiny, 0.0F, tiny})
            for (float y : {-tiny, 0.0F, tiny}) EXPECT_NEAR(depth({x, y, z}), 0.5F, 1e-3F);
        EXPECT_NEAR(std::fabs(contact(box, {0, 0, z}).normal.z), 1, 1e-5F);
    }
}

TEST(DistanceMapQuery, AnswersBatchesAsSinglePoints) {
    test::Random random(4);
    for (EntryFormat format : {EntryFormat::Float32, EntryFormat::Unorm16}) {
        const DistanceMap torus = DistanceMap::build(make_torus(1, 0.4, 60, 24), {.entry_format = format});
        std::vector<Vec3f> points(5000);
        for (Vec3f& p : points) p = test::in_cube(random, 1.5F);
        points[17].x = kNoNumber;
        std::vector<std::uint8_t> inside(points.size());
        std::vector<Contact> contacts(points.size());
        contains_batch(torus, points, inside);
        contacts_batch(torus, points, 0.05F, contacts);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(inside[i] != 0, contains(torus, points[i]));
            if (i != 17) ASSERT_TRUE(same(contacts[i], contact(torus, points[i], 0.05F)));
        }
    }
}

TEST(DistanceMapQuery, DoesNotChangeWhenMeshAndPointsMoveTogether) {
    // Powers of two and whole numbers keep floats exact, so the answers must be equal, not merely close.
    test::Random random(5);
    const TriangleMesh mesh = make_torus(1, 0.375, 32, 16);
    TriangleMesh rounded = mesh;
    for (Vec3f& v : rounded.vertices)
        v = {std::round(v.x * 4096) / 4096, std::round(v.y * 4096) / 4096, std::round(v.z * 4096) / 4096};
    const DistanceMap still = DistanceMap::build(rounded);
    const Vec3f offset{16, -8, 4};
    TriangleMesh moved = rounded;
    for (Vec3f& v : moved.vertices) v = (v + offset) * 8;
    const DistanceMap map = DistanceMap::build(moved);
    for (int n = 0; n < 20'000; ++n) {
        Vec3f p = test::in_cube(random, 1.5F);
        p = {std::round(p.x * 4096) / 4096, std::round(p.y * 4096) / 4096, std::round(p.z * 4096) / 4096};
        const Contact a = contact(still, p, 0.1F);
        const Contact b = contact(map, (p + offset) * 8, 0.8F);
        ASSERT_EQ(a.inside, b.inside);
        ASSERT_NEAR(a.depth * 8, b.depth, 1e-5F);
        ASSERT_NEAR(length(a.normal - b.normal), 0, 2e-3F);
    }
}

TEST(DistanceMapQuery, TurnsWithItsPoleAxis) {
    // Renaming the axes of mesh and points, and choosing the pole to match, gives the same map.
    test::Random random(6);
    const auto turned = [](const Vec3f& v) { return Vec3f{v.z, v.x, v.y}; };
    const TriangleMesh mesh = make_box({1, 2, 3}, 2);
    TriangleMesh renamed = mesh;
    for (Vec3f& v : renamed.vertices) v = turned(v);
    const DistanceMap z = DistanceMap::build(mesh, {.pole_axis = PoleAxis::Z});
    const DistanceMap x = DistanceMap::build(renamed, {.pole_axis = PoleAxis::X});
    for (int n = 0; n < 20'000; ++n) {
        const Vec3f p = test::in_cube(random, 2);
        ASSERT_EQ(contains(z, p), contains(x, turned(p)));
    }
}

TEST(MapSurface, OfAConvexMeshIsClosedAndOutward) {
    for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
        const DistanceMap map = DistanceMap::build(
            make_box({2, 2, 2}), {.longitude_count = 64, .colatitude_count = 32, .pole_axis = axis});
        const MapSurface surface = reconstruct_surface(map);
        const MeshReport report = inspect(surface.mesh);
        EXPECT_TRUE(report.closed);
        EXPECT_NEAR(report.signed_volume, 8, 0.15);
        EXPECT_EQ(surface.layer.size(), surface.mesh.faces.size());
    }
}

TEST(MapSurface, OfATorusHasAnInnerAndAnOuterLayerThatBothLookOutOfTheSolid) {
    const DistanceMap map = DistanceMap::build(make_torus(1, 0.4, 60, 24));
    const MapSurface surface = reconstruct_surface(map);
    int faces_of_layer[2] = {0, 0};
    for (std::size_t i = 0; i < surface.mesh.faces.size(); ++i) {
        ASSERT_LT(surface.layer[i], 2U);
        ++faces_of_layer[surface.layer[i]];
        const auto& v = surface.mesh.vertices;
        const auto [a, b, c] = surface.mesh.faces[i];
        const Vec3f normal = cross(v[b] - v[a], v[c] - v[a]);
        const Vec3f from_centre = v[a] + v[b] + v[c];
        if (surface.layer[i] == 0)
            ASSERT_LE(dot(normal, from_centre), 0);
        else
            ASSERT_GE(dot(normal, from_centre), 0);
    }
    EXPECT_EQ(faces_of_layer[0], faces_of_layer[1]);
    EXPECT_GT(faces_of_layer[0], 5000);
}

TEST(MapSurface, LeavesCellsOfUnequalCountsOpen) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.5F});
    const std::size_t all = reconstruct_surface(map.view()).mesh.faces.size();
    map.entries(2, 1) = {0.2F, 0.4F, 0.5F};
    EXPECT_EQ(reconstruct_surface(map.view()).mesh.faces.size(), all - 4 * 2);
}

// One test for each clause of the paper's section 2.2, on maps with hand-written entries.

namespace {

/// The point at a distance along the direction (phi, theta), both in units of the samples of an 8 x 4 grid.
Vec3f at(float longitude, float colatitude, float distance) {
    const float phi = longitude * 2 * std::numbers::pi_v<float> / 8;
    const float theta = (colatitude + 0.5F) * std::numbers::pi_v<float> / 4;
    return Vec3f{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} *
           distance;
}

} // namespace

TEST(PaperRules, OutsideTheBoundingSphereThereIsNoCollision) {
    test::HandMadeMap map(8, 4, true); // no entries at all: inside as far as the sphere reaches
    EXPECT_TRUE(contains(map.view(), at(1, 1, 0.999F)));
    EXPECT_FALSE(contains(map.view(), at(1, 1, 1.001F)));
}

TEST(PaperRules, DistancesAreInterpolatedBilinearly) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.5F});
    map.entries(2, 1) = {0.2F};
    map.entries(3, 1) = {0.4F};
    map.entries(2, 2) = {0.6F};
    map.entries(3, 2) = {0.8F};
    const float expected = 0.75F * (0.75F * 0.2F + 0.25F * 0.4F) + 0.25F * (0.75F * 0.6F + 0.25F * 0.8F);
    EXPECT_TRUE(contains(map.view(), at(2.25F, 1.25F, expected - 1e-4F)));
    EXPECT_FALSE(contains(map.view(), at(2.25F, 1.25F, expected + 1e-4F)));
    EXPECT_NEAR(contact(map.view(), at(2.25F, 1.25F, 0.1F)).depth, expected - 0.1F, 1e-5F);
}

TEST(PaperRules, SamplesOfAnotherLengthThanTheNearestAreIgnored) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.5F});
    map.entries(2, 1) = {0.2F, 0.3F, 0.8F};
    // Nearest to (2, 1): only that sample counts, three entries. Nearest to (3, 1): the other three, all 0.5.
    const Vec3f towards_first = at(2.45F, 1.2F, 1);
    EXPECT_EQ(usable_sample_count(map.view(), towards_first * 0.9F), 1);
    EXPECT_TRUE(contains(map.view(), towards_first * 0.1F));
    EXPECT_FALSE(contains(map.view(), towards_first * 0.25F));
    EXPECT_TRUE(contains(map.view(), towards_first * 0.6F));
    EXPECT_FALSE(contains(map.view(), towards_first * 0.9F));
    const Vec3f towards_second = at(2.55F, 1.2F, 1);
    EXPECT_EQ(usable_sample_count(map.view(), towards_second * 0.9F), 3);
    EXPECT_TRUE(contains(map.view(), towards_second * 0.49F));
    EXPECT_FALSE(contains(map.view(), towards_second * 0.51F));
}

TEST(PaperRules, WeightsOfIgnoredSamplesAreSharedByTheOthers) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.2F});
    map.entries(3, 1) = {0.6F};
    map.entries(3, 2) = {0.1F, 0.2F, 0.3F};
    // At u = 0.25, v = 0.4: weights 0.45 and 0.3 of 0.2, 0.15 of 0.6; the fourth, 0.1, is ignored.
    const float expected = (0.75F * 0.2F + 0.15F * 0.6F) / 0.9F;
    EXPECT_NEAR(contact(map.view(), at(2.25F, 1.4F, 0.05F)).depth, expected - 0.05F, 1e-5F);
}

TEST(PaperRules, EvenIntervalsAreInsideWhenTheCentreIs) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.2F, 0.4F, 0.6F});
    for (auto [distance, inside] : {std::pair{0.1F, true}, {0.3F, false}, {0.5F, true}, {0.7F, false}})
        EXPECT_EQ(contains(map.view(), at(1.3F, 1.6F, distance)), inside) << distance;
}

TEST(PaperRules, OddIntervalsAreInsideWhenTheCentreIsNot) {
    test::HandMadeMap map(8, 4, false);
    map.fill({0.2F, 0.4F, 0.6F});
    for (auto [distance, inside] : {std::pair{0.1F, false}, {0.3F, true}, {0.5F, false}, {0.7F, true}})
        EXPECT_EQ(contains(map.view(), at(1.3F, 1.6F, distance)), inside) << distance;
}

TEST(PaperRules, AParticleLeavesByTheNearestDistanceAlongItsRay) {
    test::HandMadeMap map(8, 4, false);
    map.fill({0.2F, 0.6F});
    const Contact inwards = contact(map.view(), at(1.3F, 1.6F, 0.3F));
    EXPECT_NEAR(inwards.depth, 0.1F, 1e-5F);
    EXPECT_NEAR(length(inwards.point), 0.2F, 1e-5F);
    EXPECT_LT(dot(inwards.normal, inwards.point), 0);
    const Contact outwards = contact(map.view(), at(1.3F, 1.6F, 0.55F));
    EXPECT_NEAR(outwards.depth, 0.05F, 1e-5F);
    EXPECT_NEAR(length(outwards.point), 0.6F, 1e-5F);
    EXPECT_GT(dot(outwards.normal, outwards.point), 0);
}

TEST(PaperRules, ARayWithoutEntriesIsLikeTheCentreAndLeavesByTheSphere) {
    test::HandMadeMap inside(8, 4, true);
    const Contact c = contact(inside.view(), at(1, 1, 0.25F));
    EXPECT_TRUE(c.inside);
    EXPECT_NEAR(c.depth, 0.75F, 1e-5F);
    EXPECT_NEAR(length(c.point), 1, 1e-5F);
    test::HandMadeMap outside(8, 4, false);
    EXPECT_FALSE(contact(outside.view(), at(1, 1, 0.25F), 10).found());
}

TEST(PaperRules, TheSphereIsTheFarEndWhereTheSolidHasNone) {
    test::HandMadeMap map(8, 4, false);
    map.fill({0.2F}); // the ray enters and never leaves: a hole in the far side
    EXPECT_NEAR(contact(map.view(), at(1, 1, 0.3F)).depth, 0.1F, 1e-5F);
    for (float distance : {0.9F, 1.1F}) {
        const Contact c = contact(map.view(), at(1, 1, distance), 0.2F);
        EXPECT_EQ(c.inside, distance < 1);
        EXPECT_NEAR(c.depth, 1 - distance, 1e-5F);
        EXPECT_NEAR(length(c.point), 1, 1e-5F);
        EXPECT_NEAR(dot(c.normal, c.point), 1, 1e-5F);
    }
    EXPECT_FALSE(contact(map.view(), at(1, 1, 1.1F), 0.05F).found());
}

TEST(PaperRules, ContactsNearTheCentreAreAsGoodAsElsewhere) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.5F});
    const Vec3f d = at(1.3F, 1.6F, 1);
    for (const float scale : {0x1p-10F, 0x1p-64F, 0x1p-75F, 0x1p-120F}) {
        const Contact c = contact(map.view(), d * scale);
        EXPECT_NEAR(length(cross(d, c.point)), 0, 1e-6F);
        EXPECT_NEAR(length(c.normal), 1, 1e-6F);
        EXPECT_NEAR(c.depth, 0.5F - scale, 1e-6F);
    }
}
