#include "support/meshes.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace echinus;

namespace {

template <typename T>
bool same_bytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool same_bytes(const IndexArray& a, const IndexArray& b) {
    return same_bytes(a.narrow, b.narrow) && same_bytes(a.wide, b.wide);
}

bool same(const ExactMap& a, const ExactMap& b) {
    const ExactMapView &v = a.view(), &w = b.view();
    return v.centre == w.centre && v.radius == w.radius && v.divisions == w.divisions && v.rule == w.rule &&
           same_bytes(v.band_offsets, w.band_offsets) && same_bytes(v.bands, w.bands) &&
           same_bytes(v.winding_below, w.winding_below) && same_bytes(v.references, w.references) &&
           same_bytes(v.reference_parts, w.reference_parts) && same_bytes(v.vertices, w.vertices) &&
           same_bytes(v.corners, w.corners) && same_bytes(v.face_numbers, w.face_numbers) &&
           same_bytes(v.nodes, w.nodes) && same_bytes(v.border, w.border) &&
           a.source_hash() == b.source_hash() &&
           std::memcmp(&a.statistics(), &b.statistics(), sizeof(ExactMapStatistics)) == 0;
}

TriangleMesh opened(TriangleMesh mesh) {
    mesh.faces.pop_back();
    return mesh;
}

/// A wobbling torus at one moment.
std::vector<Vec3f> wobbled(std::vector<Vec3f> vertices, double moment) {
    for (Vec3f& v : vertices) v.z += static_cast<float>(0.2 * std::sin(moment + 3.0 * double{v.x}));
    return vertices;
}

} // namespace

TEST(ExactMapBuild, GivesTheSameBytesForEveryNumberOfThreads) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    TriangleMesh with_needles = make_sphere(1, 40, 20); // whose faces at the poles collapse on the lattice
    for (Vec3f& v : with_needles.vertices) v.x *= 1e-7F;
    for (const TriangleMesh& mesh : {torus, opened(torus), with_needles, make_torus(1, 0.4, 250, 150)}) {
        const ExactMap one = ExactMap::build(mesh, {.thread_count = 1});
        for (unsigned thread_count : {2U, 3U, 0U})
            EXPECT_TRUE(same(one, ExactMap::build(mesh, {.thread_count = thread_count})));
    }
}

TEST(ExactMapBuild, GivesTheSameBytesForEveryNumberOfThreadsWhereMapsAreGivenUpOnTheWay) {
    const TriangleMesh fins = test::make_fins(400);
    for (std::size_t budget : {0U, 3'000'000U}) {
        const ExactMap one = ExactMap::build(fins, {.byte_budget = budget, .thread_count = 1});
        for (unsigned thread_count : {2U, 3U, 0U})
            EXPECT_TRUE(
                same(one, ExactMap::build(fins, {.byte_budget = budget, .thread_count = thread_count})));
    }
}

TEST(ExactMapBuild, RefusesWhatIsNoMeshAndBadOptions) {
    EXPECT_THROW(ExactMap::build({}), Error);
    EXPECT_THROW(ExactMap::build(make_box({1, 1, 1}), {.divisions = 513}), Error);
    EXPECT_THROW(ExactMap::build(make_box({1, 1, 1}), {.divisions = 4, .byte_budget = 100'000}), Error);
    EXPECT_THROW(ExactMap::build(make_box({1, 1, 1}), {.byte_budget = 100}), Error);
}

TEST(ExactMapBuild, StaysWithinItsBudgetAndUsesIt) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    std::uint32_t divisions_before = 0;
    for (std::size_t budget : {110'000U, 150'000U, 300'000U}) {
        const ExactMap map = ExactMap::build(mesh, {.byte_budget = budget});
        EXPECT_LE(map.view().byte_count(), budget);
        EXPECT_GT(map.view().divisions, divisions_before);
        const ExactMap finer = ExactMap::build(mesh, {.divisions = map.view().divisions + 1});
        EXPECT_GT(finer.view().byte_count(), budget);
        divisions_before = map.view().divisions;
    }
}

TEST(ExactMapBuild, FindsACentreThatPromisesFewerTests) {
    const TriangleMesh mesh = make_box({4, 0.5, 0.5}, 12);
    const ExactMap simple = ExactMap::build(mesh, {.divisions = 12});
    const ExactMap searched = ExactMap::build(mesh, {.divisions = 12, .centre = CentreChoice::Search});
    EXPECT_LT(searched.statistics().expected_tests, simple.statistics().expected_tests);
    for (float x = -2.2F; x < 2.2F; x += 0.37F)
        for (float y = -0.4F; y < 0.4F; y += 0.11F)
            EXPECT_EQ(contains(searched, {x, y, 0.1F}), contains(simple, {x, y, 0.1F}));
}

TEST(ExactMapBuild, CountsWhatItSaw) {
    TriangleMesh mesh = make_sphere(1, 24, 12);
    mesh.faces.push_back({0, 1, 1}); // no area
    const ExactMap map = ExactMap::build(mesh);
    const ExactMapStatistics& statistics = map.statistics();
    EXPECT_EQ(statistics.face_count, mesh.faces.size());
    EXPECT_EQ(statistics.dropped_faces, 1u);
    EXPECT_GE(statistics.longest_list, static_cast<std::uint32_t>(statistics.expected_tests));
    EXPECT_GE(statistics.expected_tests, statistics.mean_list);
    EXPECT_EQ(statistics.certain_share, 1);
    EXPECT_EQ(statistics.uncertain_directions, 0);
}

TEST(ExactMapBuilder, GivesTheBytesOfAFreshBuildForEveryMoment) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    for (CentreChoice centre : {CentreChoice::BoundingSphere, CentreChoice::Search}) {
        const ExactMapOptions options{.byte_budget = 150'000, .centre = centre};
        ExactMapBuilder builder(mesh.faces, options);
        for (double moment : {0.0, 0.7, 2.0}) {
            const TriangleMesh now{wobbled(mesh.vertices, moment), mesh.faces};
            EXPECT_TRUE(same(builder.rebuild(now.vertices), ExactMap::build(now, options)));
        }
    }
}

TEST(ExactMapBuilder, GivesTheBytesOfAFreshBuildHoweverFarTheSurfaceMoves) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    for (const TriangleMesh& mesh : {torus, opened(torus)}) {
        ExactMapBuilder builder(mesh.faces, {});
        for (int moment = 0; moment < 12; ++moment) {
            TriangleMesh now{wobbled(mesh.vertices, 0.4 * moment), mesh.faces};
            for (Vec3f& v : now.vertices) // in turn unchanged, rotated, pressed flat
                v = moment % 4 == 1   ? Vec3f{v.y, v.z, v.x}
                    : moment % 4 == 3 ? Vec3f{v.x, v.y, 1e-7F * v.z}
                                      : v;
            EXPECT_TRUE(same(builder.rebuild(now.vertices), ExactMap::build(now))) << moment;
        }
    }
}

TEST(ExactMapBuilder, TakesVerticesThatNoFaceUses) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    ExactMapBuilder builder(mesh.faces, {});
    TriangleMesh longer = mesh;
    longer.vertices.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    for (const TriangleMesh& now : {mesh, longer, mesh})
        EXPECT_TRUE(same(builder.rebuild(now.vertices), ExactMap::build(now)));
}

TEST(ExactMapBuilder, LeavesMapsAloneThatWereCopied) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    ExactMapBuilder builder(mesh.faces, {});
    const ExactMap first = builder.rebuild(mesh.vertices);
    builder.rebuild(wobbled(mesh.vertices, 1));
    EXPECT_TRUE(same(first, ExactMap::build(mesh)));
}

TEST(ExactMapBuilder, CanBeUsedAgainAfterAnError) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    ExactMapBuilder builder(mesh.faces, {});
    EXPECT_THROW(builder.rebuild(std::vector<Vec3f>(3)), Error);
    EXPECT_TRUE(same(builder.rebuild(mesh.vertices), ExactMap::build(mesh)));
}
