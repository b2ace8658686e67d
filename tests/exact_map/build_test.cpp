#include "exact_map/build/face_tree.hpp"
#include "exact_map/build/resolution.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

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

TEST(ExactMapBuilder, LeavesMapsAloneThatStillExist) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    ExactMapBuilder builder(mesh.faces, {});
    const ExactMap first = builder.rebuild(mesh.vertices);
    const ExactMap second = builder.rebuild(wobbled(mesh.vertices, 1));
    EXPECT_TRUE(same(first, ExactMap::build(mesh)));
    EXPECT_FALSE(same(first, second));
}

TEST(ExactMapBuilder, CanBeUsedAgainAfterAnError) {
    const TriangleMesh mesh = make_torus(1, 0.4, 40, 16);
    ExactMapBuilder builder(mesh.faces, {});
    EXPECT_THROW((void)builder.rebuild(std::vector<Vec3f>(3)), Error);
    EXPECT_TRUE(same(builder.rebuild(mesh.vertices), ExactMap::build(mesh)));
}

// How large a map gets.

namespace {

std::size_t bytes_of(const TriangleMesh& mesh, const ExactMapOptions& options = {}) {
    const ExactMap map = ExactMap::build(mesh, options);
    return map.view().byte_count();
}

/// The bytes of the coarsest map, from the error for a smaller budget.
std::size_t least_bytes(const TriangleMesh& mesh) {
    try {
        ExactMap::build(mesh, {.byte_budget = 1});
    } catch (const Error& error) {
        const std::string text = error.what();
        return std::stoul(text.substr(text.find('(') + 1));
    }
    return 0;
}

std::size_t default_limit(const TriangleMesh& mesh) {
    return 512 * mesh.faces.size() + 65'536;
}

} // namespace

TEST(ExactMapSize, IsLimitedByTheFacesHoweverTheyLie) {
    for (const auto& [name, mesh] : test::crowded_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        EXPECT_LE(map.view().byte_count(), default_limit(mesh)) << name;
        EXPECT_GT(map.view().byte_count(), default_limit(mesh) / 2) << name << ": coarser than need be";
        const bool open = !map.view().border.empty();
        const std::uint32_t usual = default_divisions(mesh.faces.size(), open);
        EXPECT_LT(map.view().divisions, usual) << name;
        EXPECT_GT(bytes_of(mesh, {.divisions = usual}), default_limit(mesh)) << name;
    }
}

TEST(ExactMapSize, OfOneDivisionIsWithinTheLimitOfAnyMesh) {
    for (const auto& [name, mesh] : test::crowded_meshes()) {
        const std::size_t bound = 379 * mesh.faces.size() + 8'192;
        const ExactMap map = ExactMap::build(mesh, {.byte_budget = bound});
        EXPECT_LE(map.view().byte_count(), bound) << name;
        EXPECT_LE(bytes_of(mesh, {.divisions = 1}), bound) << name;
    }
    for (const TriangleMesh& part : {test::kTetrahedron, test::kTriangle})
        for (std::size_t count : {1U, 2U, 5U, 30U}) {
            const TriangleMesh few = test::make_tangle(count, part);
            EXPECT_LE(bytes_of(few), default_limit(few)) << count;
        }
}

TEST(ExactMapSize, CountsVerticesThatNoFaceUsesOnTop) {
    TriangleMesh box = make_box({1, 1, 1});
    const ExactMap alone = ExactMap::build(box);
    box.vertices.resize(20'000);
    const ExactMap map = ExactMap::build(box);
    EXPECT_EQ(map.view().divisions, alone.view().divisions);
}

TEST(ExactMapSize, IsOnlyLimitedWhereNothingElseIsAskedFor) {
    const TriangleMesh mesh = test::make_fins(60);
    const std::size_t limit = default_limit(mesh);
    EXPECT_GT(bytes_of(mesh, {.divisions = 20}), limit);
    EXPECT_GT(bytes_of(mesh, {.byte_budget = 2 * limit}), limit);
}

TEST(ExactMapSize, TellsWhatQueriesCostInALimitedMap) {
    const TriangleMesh mesh = test::make_comb(700);
    const ExactMap limited = ExactMap::build(mesh);
    const ExactMap usual = ExactMap::build(mesh, {.divisions = default_divisions(mesh.faces.size(), false)});
    EXPECT_GT(limited.statistics().expected_tests, usual.statistics().expected_tests);
    EXPECT_GT(limited.statistics().expected_tests, 100);
    EXPECT_GE(static_cast<float>(limited.statistics().longest_list), limited.statistics().expected_tests);
}

// Those of closed surfaces are judged in tests/oracle.
TEST(ExactMapSize, GivesTheSameAnswersOfAnOpenSurfaceLimitedAsNot) {
    test::Random random(7);
    const TriangleMesh mesh = test::make_tangle(60, test::kTriangle);
    const ExactMap limited = ExactMap::build(mesh), finer = ExactMap::build(mesh, {.divisions = 20});
    ASSERT_LT(limited.view().divisions, 20U);
    for (int i = 0; i < 500; ++i) {
        const Vec3f p = limited.view().centre + test::in_sphere(random, limited.view().radius);
        ASSERT_EQ(contains(limited, p), contains(finer, p));
    }
}

TEST(ExactMapBudget, BuildsEveryMeshThatFits) {
    for (const auto& [name, mesh] : test::crowded_meshes()) {
        const std::size_t least = least_bytes(mesh);
        const ExactMap map = ExactMap::build(mesh, {.byte_budget = least});
        EXPECT_EQ(map.view().divisions, 1U) << name;
        EXPECT_EQ(map.view().byte_count(), least) << name;
        EXPECT_THROW(ExactMap::build(mesh, {.byte_budget = least - 1}), Error) << name;
    }
}

TEST(FinestWithin, FindsTheLastThatFitsInFewTrials) {
    for (const double per_map : {0.0, 1e3, 1e6})
        for (const double per_length : {0.0, 1e3})
            for (const double per_cell : {1.0, 1e3}) {
                const auto taken = [&](std::uint32_t n) {
                    return static_cast<std::size_t>(per_map + n * (per_length + per_cell * n));
                };
                for (const std::uint32_t answer : {1U, 2U, 3U, 17U, 99U, 100U}) {
                    const std::size_t limit = (taken(answer) + taken(answer + 1)) / 2;
                    std::size_t trials = 0;
                    const auto found = finest_within({limit, limit}, 100, [&](std::uint32_t n) {
                        EXPECT_LE(n, 100U);
                        ++trials;
                        return taken(n) <= limit ? std::optional(taken(n)) : std::nullopt;
                    });
                    EXPECT_EQ(found, answer);
                    EXPECT_LE(trials, 10U)
                        << per_map << " " << per_length << " " << per_cell << " " << answer;
                }
            }
}

TEST(FinestWithin, WithstandsBytesThatAreNoFunctionOfTheCells) {
    for (const std::size_t shift : {1U, 3U, 5U}) {
        const auto taken = [=](std::size_t n) {
            return 1000 + 40 * n + ((n * 2'654'435'761U >> shift) % 500);
        };
        std::size_t trials = 0;
        const auto found = finest_within({5000, 5000}, 512, [&](std::uint32_t n) {
            ++trials;
            return taken(n) <= 5000 ? std::optional(taken(n)) : std::nullopt;
        });
        ASSERT_TRUE(found);
        EXPECT_LE(taken(*found), 5000U);
        EXPECT_GT(taken(*found + 1), 5000U);
        EXPECT_LE(trials, 20U);
    }
}

TEST(FinestWithin, StopsAtWhatIsEnoughAndAtTheMost) {
    const auto squares = [](std::uint32_t n) { return std::optional(std::size_t{n} * n); };
    EXPECT_EQ(finest_within({1'000'000, 1'000'000}, 40, squares), 40U);
    EXPECT_EQ(finest_within({1'000'000, 1'000'000}, 1, squares), 1U);
    const auto found = finest_within({500, 1000}, 512, squares);
    ASSERT_TRUE(found);
    EXPECT_GE(*found * *found, 500U);
    EXPECT_EQ(finest_within({10, 10}, 512, [](std::uint32_t) { return std::optional<std::size_t>(); }),
              std::nullopt);
}

namespace {

/// @param extent  number of places along each axis
std::vector<TreeItem> random_items(std::size_t count, const std::array<std::uint32_t, 3>& extent,
                                   unsigned seed) {
    std::mt19937 random(seed);
    std::vector<TreeItem> items(count);
    for (std::uint32_t face = 0; face < count; ++face) {
        items[face].face = face;
        for (std::size_t axis = 0; axis < 3; ++axis) items[face].place[axis] = random() % extent[axis];
    }
    return items;
}

std::vector<std::uint32_t> sorted_faces(std::span<const TreeItem> items) {
    std::vector<std::uint32_t> faces;
    for (const TreeItem& item : items) faces.push_back(item.face);
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// The faces of the left half, found by sorting all of them.
std::vector<std::uint32_t> left_by_sorting(std::vector<TreeItem> items, std::size_t left_count,
                                           std::size_t axis) {
    std::sort(items.begin(), items.end(), [axis](const TreeItem& a, const TreeItem& b) {
        return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis] : a.face < b.face;
    });
    return sorted_faces(std::span(items).first(left_count));
}

} // namespace

TEST(SplitFaces, PutsTheSmallestAlongTheLongestSideFirst) {
    for (std::size_t count : {2U, 9U, 24U, 25U, 100U, 300U, 5000U})
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::uint32_t extent : {1U, 3U, 1'000'000U}) { // with many ties, and with hardly any
                std::array<std::uint32_t, 3> extents{1, 1, 1};
                extents[axis] = extent;
                std::vector<TreeItem> items = random_items(count, extents, static_cast<unsigned>(count));
                const std::size_t expected_axis = extent == 1 ? 0 : axis; // the first of equal sides
                for (std::size_t left_count : {std::size_t{1}, count / 2, count - 1}) {
                    const std::vector<std::uint32_t> expected =
                        left_by_sorting(items, left_count, expected_axis);
                    split_at_longest_side(items, left_count);
                    EXPECT_EQ(sorted_faces(std::span(items).first(left_count)), expected);
                }
            }
}

TEST(SplitFaces, MendsASplitThatIsNearlyRight) {
    std::vector<TreeItem> items = random_items(3000, {1'000'000, 10, 10}, 1);
    split_at_longest_side(items, 1400);
    std::mt19937 random(2);
    for (TreeItem& item : items) item.place[0] += random() % 20'000;
    const std::vector<std::uint32_t> expected = left_by_sorting(items, 1400, 0);
    split_at_longest_side(items, 1400);
    EXPECT_EQ(sorted_faces(std::span(items).first(1400)), expected);
}

TEST(SplitFaces, SortByNumber) {
    for (std::size_t count : {1U, 2U, 7U, 8U, 20U}) {
        std::vector<TreeItem> items = random_items(count, {9, 9, 9}, 3);
        std::shuffle(items.begin(), items.end(), std::mt19937(4));
        sort_by_face(items);
        for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(items[i].face, i);
    }
}
