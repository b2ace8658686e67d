// Shapes that designers make, by the thousand. To look further: ECHINUS_SHAPES_SEED=100000
// ECHINUS_SHAPES_COUNT=50000 test_property --gtest_filter='*Shapes*'; for millions: scripts/bench shapes.

#include "mesh/mesh_hash.hpp"
#include "property/shape_checks.hpp"
#include "property/shapes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

using namespace echinus;
using namespace echinus::test;

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
