#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace echinus;

namespace {

std::vector<float> entries_of(const DistanceMapView& map, std::size_t direction) {
    return {map.entries_float32.begin() + map.entry_offsets[direction],
            map.entries_float32.begin() + map.entry_offsets[direction + 1]};
}

ErrorCode code_of_build(const TriangleMesh& mesh, const DistanceMapOptions& options = {}) {
    try {
        DistanceMap::build(mesh, options);
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorCode::Unreadable;
}

} // namespace

TEST(DistanceMapBuild, GivesASphereOneEntryNearItsRadiusEverywhere) {
    const DistanceMap map =
        DistanceMap::build(make_sphere(2, 200, 100), {.correction = VertexCorrection::None});
    EXPECT_TRUE(map.view().centre_inside);
    EXPECT_EQ(map.view().entry_count(), 40'000U);
    const double sagitta = 2 * (1 - std::cos(std::numbers::pi / 100)); // a facet's distance below the sphere
    for (float entry : map.view().entries_float32) {
        EXPECT_LE(entry, 2.00001F);
        EXPECT_GE(entry, 2 - sagitta);
    }
}

TEST(DistanceMapBuild, GivesATorusTwoEntriesWhereItsRayMeetsTheTube) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    const DistanceMap map = DistanceMap::build(torus, {.correction = VertexCorrection::None});
    EXPECT_FALSE(map.view().centre_inside);
    EXPECT_EQ(map.statistics().max_entries, 2U);
    const auto histogram = entry_histogram(map);
    ASSERT_EQ(histogram.size(), 3U);
    EXPECT_EQ(histogram[1], 0U);
    // In the half plane of one longitude the ray at elevation a meets the circle of the tube where cos(a) -+
    // sqrt(0.16 - sin(a)^2); the facets lie at most 0.02 inside it.
    for (std::uint32_t j = 0; j < 200; ++j)
        for (std::uint32_t i = 0; i < 200; ++i) {
            const double elevation = std::numbers::pi * (0.5 - (j + 0.5) / 200);
            const double under_root = 0.16 - std::sin(elevation) * std::sin(elevation);
            const auto entries = entries_of(map, j * 200 + i);
            if (under_root < 0) ASSERT_TRUE(entries.empty());
            if (under_root < 0.02) continue;
            ASSERT_EQ(entries.size(), 2U);
            ASSERT_NEAR(entries[0], std::cos(elevation) - std::sqrt(under_root), 0.03);
            ASSERT_NEAR(entries[1], std::cos(elevation) + std::sqrt(under_root), 0.03);
        }
}

TEST(DistanceMapBuild, KeepsEntriesSortedInTheSphereForEveryCorrectionAndFormat) {
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 24, 10), make_box({1, 2, 0.1}, 3), make_sphere(1, 9, 5)})
        for (auto correction : {VertexCorrection::None, VertexCorrection::Paper, VertexCorrection::Signed})
            for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
                const DistanceMap map = DistanceMap::build(mesh, {.longitude_count = 64,
                                                                  .colatitude_count = 33,
                                                                  .correction = correction,
                                                                  .pole_axis = axis});
                for (std::size_t d = 0; d < map.view().direction_count(); ++d) {
                    const auto entries = entries_of(map, d);
                    ASSERT_TRUE(std::is_sorted(entries.begin(), entries.end()));
                    for (float entry : entries) ASSERT_TRUE(entry >= 0 && entry <= map.view().radius);
                }
            }
}

TEST(DistanceMapBuild, GivesTheSameBytesForEveryNumberOfThreads) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    const DistanceMap one = DistanceMap::build(mesh, {.thread_count = 1});
    for (unsigned thread_count : {0U, 2U, 3U}) {
        const DistanceMap many = DistanceMap::build(mesh, {.thread_count = thread_count});
        EXPECT_TRUE(std::ranges::equal(many.view().entry_offsets, one.view().entry_offsets));
        EXPECT_TRUE(std::ranges::equal(many.view().entries_float32, one.view().entries_float32));
        EXPECT_EQ(many.source_hash(), one.source_hash());
    }
}

TEST(DistanceMapBuild, StoresUnorm16EntriesWithinTheStatedError) {
    const TriangleMesh mesh = make_torus(1, 0.4, 60, 24);
    const DistanceMap exact = DistanceMap::build(mesh);
    const DistanceMap small = DistanceMap::build(mesh, {.entry_format = EntryFormat::Unorm16});
    const DistanceMapView& view = small;
    ASSERT_EQ(view.entries_unorm16.size(), exact.view().entry_count());
    EXPECT_TRUE(view.entries_float32.empty());
    for (std::size_t i = 0; i < view.entries_unorm16.size(); ++i)
        ASSERT_NEAR(static_cast<float>(view.entries_unorm16[i]) / 65535 * view.radius,
                    exact.view().entries_float32[i], view.radius / 131070 * 1.01F);
    EXPECT_EQ(view.byte_count(), exact.view().byte_count() - 2 * view.entries_unorm16.size());
}

TEST(DistanceMapBuild, ReportsTheShareOfDirectionsThatLookThroughAHole) {
    TriangleMesh open = make_sphere(1, 40, 20);
    std::erase_if(open.faces, [&](const Triangle& face) {
        return open.vertices[face[0]].z + open.vertices[face[1]].z + open.vertices[face[2]].z > 2.4F;
    });
    const DistanceMap map = DistanceMap::build(open);
    EXPECT_TRUE(map.view().centre_inside);
    const auto histogram = entry_histogram(map);
    EXPECT_FLOAT_EQ(map.statistics().wrong_parity_share, static_cast<float>(histogram[0]) / 40'000);
    EXPECT_GT(map.statistics().wrong_parity_share, 0.01F);
    EXPECT_EQ(DistanceMap::build(make_sphere(1, 40, 20)).statistics().wrong_parity_share, 0);
}

TEST(DistanceMapBuild, IdentifiesItsSource) {
    const TriangleMesh mesh = make_box({1, 1, 1});
    const auto hash = [&](const DistanceMapOptions& options) {
        return DistanceMap::build(mesh, options).source_hash();
    };
    EXPECT_EQ(hash({}), hash({.thread_count = 1}));
    EXPECT_NE(hash({}), hash({.pole_axis = PoleAxis::X}));
    EXPECT_NE(hash({}), hash({.correction = VertexCorrection::None}));
    EXPECT_NE(hash({}), DistanceMap::build(make_box({1, 1, 2})).source_hash());
}

TEST(DistanceMapBuild, RefusesBadOptionsAndBadMeshes) {
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_EQ(code_of_build(box, {.longitude_count = 3}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of_build(box, {.colatitude_count = 8193}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of_build({}), ErrorCode::InvalidMesh);
    TriangleMesh broken = box;
    broken.vertices[2].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(code_of_build(broken), ErrorCode::InvalidMesh);
    broken = box;
    broken.faces[5][1] = 1000;
    EXPECT_EQ(code_of_build(broken), ErrorCode::InvalidMesh);
    EXPECT_EQ(code_of_build({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}), ErrorCode::InvalidMesh);
}

TEST(DistanceMapBuild, AcceptsOneFaceHugeAndTinyCoordinatesAndNeedles) {
    const TriangleMesh one_face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const DistanceMap flat = DistanceMap::build(one_face);
    EXPECT_FALSE(flat.view().centre_inside);
    for (double size : {1e9, 1e-9}) {
        const DistanceMap map = DistanceMap::build(make_box({size, size, size}));
        EXPECT_TRUE(contains(map, Vec3f(Vec3d{0.49, 0.49, 0.49} * size)));
        EXPECT_FALSE(contains(map, Vec3f(Vec3d{0.51, 0.4, 0.4} * size)));
    }
    const DistanceMap needle = DistanceMap::build(make_box({1, 1e-6, 1e-6}));
    EXPECT_TRUE(needle.view().centre_inside);
    EXPECT_EQ(needle.statistics().wrong_parity_share, 0);
}
