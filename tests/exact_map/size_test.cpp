// How large a map gets.

#include "exact_map/build/resolution.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

using namespace echinus;

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
