#include "property/shape_judge.hpp"
#include "property/shape_parts.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

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
