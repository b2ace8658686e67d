#include "mesh/mesh_hash.hpp"
#include "property/shape_checks.hpp"
#include "property/shape_judge.hpp"
#include "property/shape_parts.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

using namespace echinus;
using namespace echinus::test;

// Shapes that designers make, by the thousand. To look further: ECHINUS_SHAPES_SEED=100000
// ECHINUS_SHAPES_COUNT=50000 test_property --gtest_filter='*Shapes*'; for millions: scripts/bench shapes.

namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

constexpr std::uint64_t kPortions = 4; ///< of a test, so that it runs on several cores
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kDivisor = 20; ///< of the counts, where all takes so much longer
#else
constexpr std::uint64_t kDivisor = 1;
#endif

class Shapes : public testing::TestWithParam<std::uint64_t> {
  protected:
    /// Checks one portion of so many seeds, unless the environment has other ones.
    void expect_right(ShapeCheck check, std::uint64_t count) {
        const std::uint64_t first = from_environment("ECHINUS_SHAPES_SEED", 1);
        const std::uint64_t portion = from_environment("ECHINUS_SHAPES_COUNT", count / kDivisor) / kPortions;
        ShapeFindings findings;
        for (std::uint64_t i = 0; i < portion; ++i) {
            const std::uint64_t seed = first + GetParam() * portion + i;
            check(make_shape(seed).mesh, seed, findings);
        }
        EXPECT_EQ(findings.failures.size(), 0U)
            << "of " << portion << " shapes from seed " << first + GetParam() * portion << " on";
        for (std::size_t i = 0; i < findings.failures.size() && i < 3; ++i)
            explain(findings.failures[i], check);
        EXPECT_GE(findings.answers, portion - findings.left_out);
    }

  private:
    static void explain(const ShapeFindings::Failure& failure, ShapeCheck check) {
        const Shape shape = make_shape(failure.seed);
        ADD_FAILURE() << "seed " << failure.seed << ", " << shape.recipe << ": " << failure.what
                      << "\nfails, too:\n"
                      << obj_text(shrunk(shape.mesh, failure, check));
    }
};

INSTANTIATE_TEST_SUITE_P(Portion, Shapes, testing::Range<std::uint64_t>(0, kPortions));

} // namespace

TEST_P(Shapes, HaveRightSidesAlsoAfterSavingAndLoadingTheirMaps) {
    expect_right(check_sides, 10'000);
}

TEST_P(Shapes, HaveRightContactsDistancesSweepsAndClearances) {
    expect_right(check_queries, 1'500);
}

TEST_P(Shapes, AreFilledWithTetrahedra) {
    expect_right(check_tetrahedra, 40);
}

TEST(ShapeOfASeed, IsTheSameOnEveryMachine) {
    std::uint64_t hash = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) hash = mesh_hash(make_shape(seed).mesh, hash);
    EXPECT_EQ(hash, 14768266200306839461U);
}

TEST(ShapeOfASeed, IsClosed) {
    for (std::uint64_t seed = 1; seed <= 2'000; ++seed) {
        const Shape shape = make_shape(seed);
        ASSERT_TRUE(inspect(shape.mesh).closed) << "seed " << seed << ", " << shape.recipe;
    }
}

namespace {

TriangleMesh box(const GridPoint& low, const GridPoint& high, int height) {
    Choices choices(1);
    return extruded({low, {high.x, low.y}, high, {low.x, high.y}}, height, choices);
}

/// By eighths about each axis. Corners stay whole numbers, and the volume becomes kTurnFactor times as large.
TriangleMesh turned(const TriangleMesh& mesh) {
    return turned_by_eighth(turned_by_eighth(turned_by_eighth(mesh, 2), 0), 1);
}
constexpr double kTurnFactor = 8;
constexpr double kSubdivideFactor = 64; ///< of subdivided()

double enclosed_volume(const TriangleMesh& mesh) {
    return ShapeJudge(mesh, 0).enclosed_volume();
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
    append(a, b);
    return a;
}

} // namespace

TEST(ShapeJudge, KnowsTheVolumeOfASlantingPlate) {
    const double volume = kTurnFactor * 40 * 40;
    EXPECT_NEAR(enclosed_volume(turned(box({-20, -20}, {20, 20}, 1))), volume, 1e-6 * volume);
}

TEST(ShapeJudge, KnowsTheVolumeOfPyramidsHoweverTheyAreSubdivided) {
    Choices choices(2);
    const TriangleMesh pyramid =
        turned(tapered_to({{0, 0}, {9, 1}, {12, 5}, {3, 2}}, {-4.0F, 1.0F, 3.0F}, choices));
    constexpr double kBase = 21, kHeight = 3;
    const double volume = kSubdivideFactor * kTurnFactor * kBase * kHeight / 3;
    for (int i = 0; i < 20; ++i)
        ASSERT_NEAR(enclosed_volume(subdivided(pyramid, choices)), volume, 1e-6 * volume);
}

TEST(ShapeJudge, CountsOnceWhatIsEnclosedSeveralTimes) {
    const TriangleMesh whole = box({0, 0}, {12, 9}, 6), part = moved(box({2, 3}, {5, 7}, 3), {0, 0, 2});
    const double volume = kTurnFactor * 648;
    EXPECT_NEAR(enclosed_volume(turned(joined(whole, whole))), volume, 1e-6 * volume);
    EXPECT_NEAR(enclosed_volume(turned(joined(whole, part))), volume, 1e-6 * volume);
    EXPECT_NEAR(enclosed_volume(turned(inside_out(whole))), volume, 1e-6 * volume);
    const double hollow = kTurnFactor * (648 - 36);
    EXPECT_NEAR(enclosed_volume(turned(joined(whole, inside_out(part)))), hollow, 1e-6 * hollow);
}

TEST(ShapeJudge, KnowsTheVolumeOfBoxesThatPassThroughEachOther) {
    const TriangleMesh crossing = joined(box({0, 0}, {12, 2}, 6), moved(box({4, -5}, {7, 9}, 3), {0, 0, 1}));
    const double volume = kTurnFactor * (144 + 126 - 18);
    EXPECT_NEAR(enclosed_volume(turned(crossing)), volume, 1e-3 * volume);
}
