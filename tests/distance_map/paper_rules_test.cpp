// One test for each clause of the paper's section 2.2, on maps with hand-written entries.

#include "support/distance_maps.hpp"

#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace echinus;

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
