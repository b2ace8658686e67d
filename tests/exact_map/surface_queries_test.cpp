#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/surface_queries.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

TrianglePoints random_triangle(Random& random, const ExactMap& map, float size) {
    const float radius = map.view().radius;
    const Vec3f middle = map.view().centre + in_sphere(random, 1.3F * radius);
    return {middle + in_cube(random, size * radius), middle + in_cube(random, size * radius),
            middle + in_cube(random, size * radius)};
}

TrianglePoints corners_of(const TriangleMesh& mesh, std::size_t face) {
    const auto [a, b, c] = mesh.faces[face];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

// ---- Distances by brute force: the smallest over a grid of points, refined around the best ----

using Corners = std::array<Vec3d, 3>;

Vec3d point_of(const Corners& t, double u, double v) {
    return t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
}

double distance_to_triangle(const Vec3d& p, const TriangleMesh& triangle) {
    return unsigned_distance(triangle, p);
}

/// The distance of a convex function from its smallest value on a triangle: ternary search in both
/// directions.
double distance_by_search(const TrianglePoints& a, const TrianglePoints& b) {
    const TriangleMesh face{{b[0], b[1], b[2]}, {{0, 1, 2}}};
    const Corners t{Vec3d(a[0]), Vec3d(a[1]), Vec3d(a[2])};
    const auto least_along_v = [&](double u) {
        double low = 0, high = 1 - u;
        for (int i = 0; i < 60; ++i) {
            const double third = (high - low) / 3;
            if (distance_to_triangle(point_of(t, u, low + third), face) <
                distance_to_triangle(point_of(t, u, high - third), face))
                high -= third;
            else
                low += third;
        }
        return distance_to_triangle(point_of(t, u, low), face);
    };
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double third = (high - low) / 3;
        if (least_along_v(low + third) < least_along_v(high - third))
            high -= third;
        else
            low += third;
    }
    return least_along_v(low);
}

/// The mesh that a map's queries see, with the numbers of its faces in the original.
struct SeenSurface {
    TriangleMesh mesh;
    std::vector<std::uint32_t> numbers;

    explicit SeenSurface(const ExactMap& map) : mesh(reconstruct_surface(map.view()).mesh) {
        for (std::size_t i = 0; i < map.view().face_count(); ++i)
            numbers.push_back(map.view().face_numbers[i]);
    }
};

} // namespace

// ---- intersects() ----

TEST(TriangleIntersects, AgreesWithTheJudgeOnTheLattice) {
    Random random(1);
    for (const TriangleMesh& mesh : {make_torus(1, 0.4, 30, 12), make_box({2, 1, 0.25}, 3)}) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        // In lattice steps, where floats hold every point.
        TriangleMesh lattice;
        for (const auto& v : view.vertices) lattice.vertices.push_back(Vec3f(v));
        for (std::size_t f = 0; f < view.face_count(); ++f)
            lattice.faces.push_back({view.corners[3 * f], view.corners[3 * f + 1], view.corners[3 * f + 2]});
        const double per_step = 524288.0 / view.radius;
        std::size_t meeting = 0;
        for (int i = 0; i < 3000; ++i) {
            const TrianglePoints triangle = random_triangle(random, map, i % 3 == 0 ? 1.0F : 0.1F);
            TriangleMesh snapped{{}, {{0, 1, 2}}};
            for (const Vec3f& p : triangle) {
                const Vec3d place = (Vec3d(p) - Vec3d(view.centre)) * per_step;
                snapped.vertices.push_back(
                    Vec3f(Vec3d(std::nearbyint(place.x), std::nearbyint(place.y), std::nearbyint(place.z))));
            }
            const bool expected = !intersecting_pairs(snapped, lattice).empty();
            ASSERT_EQ(intersects(view, triangle), expected) << i;
            meeting += expected;
        }
        EXPECT_GT(meeting, 300U);
        EXPECT_LT(meeting, 2700U);
    }
}

TEST(TriangleIntersects, IsTrueForEveryFaceEdgeAndVertexOfTheMesh) {
    const TriangleMesh mesh = make_torus(1, 0.4, 30, 12);
    const ExactMap map = ExactMap::build(mesh);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const auto [a, b, c] = corners_of(mesh, face);
        EXPECT_TRUE(intersects(map.view(), {a, b, c}));
        EXPECT_TRUE(intersects(map.view(), {b, c, c}));
        EXPECT_TRUE(intersects(map.view(), {c, c, c}));
    }
}

TEST(TriangleIntersects, IsFalseInsideAndForWhatIsNotFinite) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}, 4));
    EXPECT_FALSE(intersects(map.view(), {{{-0.5F, 0, 0}, {0.5F, 0, 0}, {0, 0.5F, 0.9F}}}));
    EXPECT_TRUE(intersects(map.view(), {{{-0.5F, 0, 0}, {0.5F, 0, 0}, {0, 0.5F, 1.1F}}}));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kFloatInfinity}) {
        const TrianglePoints spoilt{{{-5, 0, 0}, {5, 0, 0}, {0, bad, 0}}};
        EXPECT_FALSE(intersects(map.view(), spoilt));
        EXPECT_FALSE(clearance(map.view(), spoilt).found());
        EXPECT_FALSE(sweep(map.view(), spoilt, {}).found());
        EXPECT_FALSE(sweep(map.view(), {}, spoilt).found());
    }
    const float huge = 1e31F;
    EXPECT_TRUE(intersects(map.view(), {{{-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}}}));
    EXPECT_FALSE(intersects(map.view(), {{{-huge, -huge, huge}, {huge, -huge, huge}, {0, huge, huge}}}));
}

// ---- clearance() ----

TEST(TriangleClearance, IsTheLeastDistanceOfAnyFaceAndNeverMore) {
    Random random(2);
    const ExactMap map = ExactMap::build(make_box({2, 1, 0.25}, 2));
    const SeenSurface seen(map);
    for (int i = 0; i < 60; ++i) {
        TrianglePoints triangle = random_triangle(random, map, i % 2 == 0 ? 0.05F : 0.5F);
        if (i % 5 == 0) triangle[2] = triangle[1];
        if (i % 10 == 0) triangle[1] = triangle[2] = triangle[0];
        double expected = kFloatInfinity;
        for (std::size_t face = 0; face < seen.mesh.faces.size(); ++face)
            expected = std::min(expected, distance_by_search(triangle, corners_of(seen.mesh, face)));
        const Clearance found = clearance(map.view(), triangle);
        ASSERT_LE(found.distance, expected + 1e-7) << i;
        ASSERT_NEAR(found.distance, expected, 2e-6) << i;
        ASSERT_TRUE(found.found());
    }
}

TEST(TriangleClearance, IsZeroWhereTrianglesIntersect) {
    Random random(3);
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 30, 12));
    int meeting = 0;
    for (int i = 0; i < 5000; ++i) {
        const TrianglePoints triangle = random_triangle(random, map, 0.3F);
        const float distance = clearance(map.view(), triangle).distance;
        // Snapping moves the triangle by a step at most.
        if (intersects(map.view(), triangle)) ASSERT_LE(distance, 2e-6F * map.view().radius);
        if (distance > 2e-6F * map.view().radius) ASSERT_FALSE(intersects(map.view(), triangle));
        meeting += distance == 0;
    }
    EXPECT_GT(meeting, 500);
    EXPECT_LT(meeting, 4500);
}

TEST(TriangleClearance, LooksNoFartherThanAsked) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}, 4));
    const TrianglePoints above{{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}};
    EXPECT_NEAR(clearance(map.view(), above).distance, 1, 1e-5);
    EXPECT_NEAR(clearance(map.view(), above, 1.1F).distance, 1, 1e-5);
    EXPECT_EQ(clearance(map.view(), above, 0.9F).distance, 0.9F);
    EXPECT_FALSE(clearance(map.view(), above, 0.9F).found());
    const float huge = std::numeric_limits<float>::max();
    const Clearance far = clearance(map.view(), {{{0, 0, huge}, {1, 0, huge}, {0, 1, huge}}});
    EXPECT_FALSE(far.found());
    EXPECT_GT(far.distance, 1e11F);
    EXPECT_LT(far.distance, huge);
}

// ---- sweep() ----

TEST(TriangleSweep, StopsBeforeTheSurfaceAndNearIt) {
    Random random(4);
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 30, 12));
    const float radius = map.view().radius;
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const TrianglePoints from = random_triangle(random, map, 0.1F);
        const Vec3f common = in_sphere(random, radius);
        TrianglePoints to;
        for (std::size_t k = 0; k < 3; ++k)
            to[k] = from[k] + common + in_cube(random, i % 2 == 0 ? 0 : 0.2F * radius);
        const TriangleSweepHit hit = sweep(map.view(), from, to);
        const auto at = [&](float share) {
            TrianglePoints now;
            for (std::size_t k = 0; k < 3; ++k) now[k] = from[k] + (to[k] - from[k]) * share;
            return now;
        };
        // Nothing is met on the way, which ends near the surface.
        for (int step = 0; step < 50 && hit.fraction > 0; ++step) {
            const float share = hit.fraction * static_cast<float>(step) / 50;
            ASSERT_FALSE(intersects(map.view(), at(share))) << i << " at " << share << " of " << hit.fraction;
        }
        if (!hit.found()) {
            ASSERT_EQ(hit.fraction, 1);
            continue;
        }
        ++hits;
        ASSERT_LT(clearance(map.view(), at(hit.fraction)).distance, 1e-5F * radius) << i;
    }
    EXPECT_GT(hits, 300);
    EXPECT_LT(hits, 900);
}

TEST(TriangleSweep, OfATriangleThatFallsOnABoxIsTheHeight) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}, 4));
    const TrianglePoints from{{{-0.3F, 0, 2}, {0.4F, 0, 2.25F}, {0, 0.5F, 2.5F}}};
    TrianglePoints to = from;
    for (Vec3f& p : to) p.z -= 4;
    const TriangleSweepHit hit = sweep(map.view(), from, to);
    EXPECT_NEAR(hit.fraction, 0.25, 1e-5);
    EXPECT_LE(hit.fraction, 0.25);
    const TriangleSweepHit edge = sweep(map.view(), {from[1], from[2], from[2]}, {to[1], to[2], to[2]});
    EXPECT_NEAR(edge.fraction, 1.25 / 4, 1e-5);
    for (Vec3f& p : to) p.z = 1.5F;
    EXPECT_FALSE(sweep(map.view(), from, to).found());
}

TEST(TriangleSweep, ComesToAWallAlongAFloorThatItSlowlyLeaves) {
    Random random(9);
    TriangleMesh mesh = make_box({4, 4, 1}, 4);
    const auto floor_count = static_cast<std::uint32_t>(mesh.vertices.size());
    const TriangleMesh wall = make_box({1, 4, 4}, 4);
    for (const Vec3f& v : wall.vertices) mesh.vertices.push_back(v + Vec3f{3, 0, 0});
    for (const auto& [a, b, c] : wall.faces)
        mesh.faces.push_back({a + floor_count, b + floor_count, c + floor_count});
    const ExactMap map = ExactMap::build(mesh);
    for (int i = 0; i < 100; ++i) {
        const float height = 0.5F + 1e-4F;
        TrianglePoints from;
        for (Vec3f& p : from) p = Vec3f{uniform(random, -1.9F, 1.0F), uniform(random, -1.0F, 1.0F), height};
        // Corners rise and move across differently, so that the edges turn.
        const TrianglePoints to{from[0] + Vec3f{5, i % 2 == 0 ? 0.0F : 0.5F, 0.02F},
                                from[1] + Vec3f{5, 0, uniform(random, 0.01F, 0.05F)},
                                from[2] + Vec3f{5, 0, 0.02F}};
        const float foremost = std::max({from[0].x, from[1].x, from[2].x});
        const TriangleSweepHit hit = sweep(map.view(), from, to);
        ASSERT_TRUE(hit.found()) << i;
        ASSERT_NEAR(hit.fraction, (2.5F - foremost) / 5, 1e-5) << i;
        ASSERT_LE(hit.fraction, (2.5F - foremost) / 5 + 1e-6F) << i;
    }
}

TEST(TriangleSweep, PassesAnEdgeAroundWhichItTurnsJustBeyondReach) {
    // The middle of an edge slides along an edge of the box while its direction turns from one side of the
    // box to the other: the planes between them turn, too.
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}, 1));
    const float above = 1 + 3e-5F;
    for (const float reach : {0.1F, 1.0F, 10.0F}) {
        const Vec3f first{-0.9F, above, above}, last{0.9F, above, above};
        const TrianglePoints from{first + Vec3f{0, reach, 0}, first - Vec3f{0, reach, 0},
                                  first - Vec3f{0, reach, 0}};
        const TrianglePoints to{last - Vec3f{0, 0, reach}, last + Vec3f{0, 0, reach},
                                last + Vec3f{0, 0, reach}};
        EXPECT_FALSE(sweep(map.view(), from, to).found()) << reach;
        TrianglePoints into = to;
        for (Vec3f& p : into) p -= Vec3f{0, 1e-3F, 1e-3F};
        const TriangleSweepHit hit = sweep(map.view(), from, into);
        EXPECT_TRUE(hit.found()) << reach;
        EXPECT_NEAR(hit.fraction, 0.03F, 0.015F) << reach;
    }
}

TEST(TriangleSweep, MeetsWhatLiesOnItsWayFromAnyDistanceUpToItsLimit) {
    Random random(8);
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 30, 12));
    const float radius = map.view().radius;
    for (int i = 0; i < 600; ++i) {
        const float far = std::pow(10.0F, static_cast<float>(i % 12)) * radius;
        const Vec3f way = unit_vector(random) * far;
        // Into the torus, and out on the other side. Far away the corners are one.
        const Vec3f start = -way, middle{1, 0, 0};
        const TrianglePoints from{start, start + Vec3f{0, 0.1F, 0}, start + Vec3f{0, 0, 0.1F}};
        const TrianglePoints to{middle, middle + Vec3f{0, 0.1F, 0}, middle + Vec3f{0, 0, 0.1F}};
        ASSERT_TRUE(sweep(map.view(), from, to).found()) << far;
        TrianglePoints beyond;
        for (std::size_t k = 0; k < 3; ++k) beyond[k] = -from[k];
        const TriangleSweepHit out = sweep(map.view(), to, beyond); // from within
        ASSERT_TRUE(out.found()) << far;
        ASSERT_LT(out.fraction * far, 2 * radius) << far;
    }
    const TrianglePoints nowhere{{{1e13F, 0, 0}, {1e13F, 1, 0}, {1e13F, 0, 1}}};
    EXPECT_FALSE(sweep(map.view(), nowhere, {{{1, 0, 0}, {1, 0.1F, 0}, {1, 0, 0.1F}}}).found());
}

// ---- faces_within_batch() ----

TEST(FacesWithin, AreThoseWhoseDistanceIsWithinReach) {
    Random random(5);
    const ExactMap map = ExactMap::build(make_box({2, 1, 0.25}, 2));
    const SeenSurface seen(map);
    TriangleMesh sheet;
    for (std::uint32_t i = 0; i < 20; ++i) {
        for (const Vec3f& p : random_triangle(random, map, 0.3F)) sheet.vertices.push_back(p);
        sheet.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    FaceLists lists;
    const float reach = 0.3F;
    faces_within_batch(map.view(), sheet.vertices, sheet.faces, reach, lists);
    ASSERT_EQ(lists.offsets.size(), sheet.faces.size() + 1);
    std::size_t found = 0;
    for (std::size_t i = 0; i < sheet.faces.size(); ++i)
        for (std::size_t face = 0; face < seen.mesh.faces.size(); ++face) {
            const double distance = distance_by_search(corners_of(sheet, i), corners_of(seen.mesh, face));
            const bool listed = std::binary_search(lists[i].begin(), lists[i].end(), seen.numbers[face]);
            if (std::fabs(distance - reach) > 2e-6) ASSERT_EQ(listed, distance < reach) << i << ", " << face;
            found += listed;
        }
    EXPECT_GT(found, 30U);
    EXPECT_LT(found, sheet.faces.size() * seen.mesh.faces.size() / 2);
}

TEST(FacesWithin, AreTheSameOnAnyNumberOfThreadsAndInAListThatWasUsedBefore) {
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 60, 24));
    const TriangleMesh sphere = make_sphere(1.1, 60, 40);
    FaceLists expected;
    faces_within_batch(map.view(), sphere.vertices, sphere.faces, 0.05F, expected, 1);
    EXPECT_GT(expected.faces.size(), 1000U);
    for (const unsigned thread_count : {0U, 2U, 3U, 8U}) {
        FaceLists lists;
        lists.faces = {1, 2, 3};
        faces_within_batch(map.view(), sphere.vertices, sphere.faces, 0.05F, lists, thread_count);
        EXPECT_EQ(lists.offsets, expected.offsets);
        EXPECT_EQ(lists.faces, expected.faces);
    }
    faces_within_batch(map.view(), sphere.vertices, {}, 0.05F, expected);
    EXPECT_EQ(expected.offsets, std::vector<std::uint32_t>{0});
    EXPECT_TRUE(expected.faces.empty());
}

TEST(FacesWithin, AndClearancesAreTheSameUnderEveryInstructionSet) {
    Random random(7);
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 60, 24));
    TriangleMesh sheet = make_sphere(1.1, 60, 40);
    for (Vec3f& vertex : sheet.vertices) vertex += in_cube(random, 0.02F);
    sheet.faces.push_back({0, 1, 1}); // an edge, a point, a sliver and a triangle larger than the lattice
    sheet.faces.push_back({0, 0, 0});
    sheet.vertices.push_back({1, 0, 1e-6F});
    sheet.vertices.push_back({1e3F, 1e3F, 0});
    sheet.vertices.push_back({-1e3F, 1e3F, 0});
    const auto last = static_cast<std::uint32_t>(sheet.vertices.size() - 1);
    sheet.faces.push_back({0, 1, last - 2});
    sheet.faces.push_back({last - 2, last - 1, last});
    FaceLists expected;
    std::vector<Clearance> clearances;
    under_each_instruction_set([&](std::string_view name) {
        FaceLists lists;
        std::vector<Clearance> found;
        faces_within_batch(map.view(), sheet.vertices, sheet.faces, 0.05F, lists);
        for (std::size_t face = 0; face < sheet.faces.size(); ++face)
            found.push_back(clearance(map.view(), corners_of(sheet, face)));
        if (clearances.empty()) {
            expected = lists;
            clearances = found;
            EXPECT_GT(expected.faces.size(), 1000U);
        }
        EXPECT_EQ(lists.offsets, expected.offsets) << name;
        EXPECT_EQ(lists.faces, expected.faces) << name;
        for (std::size_t face = 0; face < found.size(); ++face) {
            ASSERT_EQ(found[face].distance, clearances[face].distance) << name << ", " << face;
            ASSERT_EQ(found[face].face, clearances[face].face) << name << ", " << face;
        }
    });
}

TEST(FacesWithin, HoldTheFaceOfTheClearance) {
    Random random(6);
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 30, 12));
    FaceLists lists;
    for (int i = 0; i < 500; ++i) {
        const TrianglePoints triangle = random_triangle(random, map, 0.2F);
        const Clearance nearest = clearance(map.view(), triangle);
        faces_within_batch(map.view(), triangle, std::vector<Triangle>{{0, 1, 2}},
                           nearest.distance * 1.001F + 1e-6F, lists);
        ASSERT_TRUE(std::binary_search(lists[0].begin(), lists[0].end(), nearest.face)) << i;
        faces_within_batch(map.view(), triangle, std::vector<Triangle>{{0, 1, 2}},
                           std::max(0.0F, nearest.distance * 0.999F - 1e-6F), lists);
        if (nearest.distance > 1e-5F) ASSERT_TRUE(lists[0].empty()) << i;
    }
}

TEST(SurfaceQueries, AnswerInBatchesAsOneByOneOnAnyNumberOfThreads) {
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 24, 12));
    constexpr std::size_t kCount = 33'000; // so many that threads share them
    Random random(41);
    std::vector<TrianglePoints> from, to;
    for (std::size_t i = 0; i < kCount; ++i) {
        from.push_back(random_triangle(random, map, 0.1F));
        to.push_back(random_triangle(random, map, 0.1F));
    }
    for (const unsigned thread_count : {1U, 2U}) {
        std::vector<std::uint8_t> meets(kCount);
        std::vector<Clearance> clearances(kCount);
        std::vector<TriangleSweepHit> hits(kCount);
        intersects_batch(map, from, meets, thread_count);
        clearance_batch(map, from, 0.2F, clearances, thread_count);
        sweep_batch(map, from, to, hits, thread_count);
        for (std::size_t i = 0; i < kCount; i += 37) {
            EXPECT_EQ(meets[i] != 0, intersects(map, from[i])) << i;
            const Clearance clear = clearance(map, from[i], 0.2F);
            EXPECT_EQ(clearances[i].face, clear.face) << i;
            EXPECT_EQ(clearances[i].distance, clear.distance) << i;
            const TriangleSweepHit hit = sweep(map, from[i], to[i]);
            EXPECT_EQ(hits[i].face, hit.face) << i;
            EXPECT_EQ(hits[i].fraction, hit.fraction) << i;
        }
    }
}
