#include "compare/errors.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::comparison;

namespace {

/// Four particles on the x axis of a solid x < 0: at -4, -2, 1 and 3.
Truth half_space() {
    return {{1, 1, 0, 0}, {4, 2, 1, 3}, {{1, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}}};
}

Answers right_answers() {
    return {{0, 1, 2, 3}, {1, 1, 0, 0}, {4, 2, 0, 0}, {{1, 0, 0}, {1, 0, 0}, {}, {}}};
}

} // namespace

TEST(Errors, AreAllZeroForRightAnswers) {
    const ErrorSummary errors = errors_of(half_space(), 10, right_answers());
    EXPECT_EQ(errors.asked_count, 4U);
    EXPECT_EQ(errors.wrong_share, 0);
    EXPECT_EQ(errors.farthest_wrong, 0);
    EXPECT_EQ(errors.depth.worst, 0);
    EXPECT_EQ(errors.normal.worst, 0);
}

TEST(Errors, OfDepthAndNormalAreToldToBeOfNobodyWhereNobodyIsInside) {
    const ErrorSummary outside = errors_of(half_space(), 10, {{2, 3}, {0, 0}, {0, 0}, {{}, {}}});
    EXPECT_EQ(outside.depth.count, 0U);
    EXPECT_EQ(outside.normal.count, 0U);
    const ErrorSummary found = errors_of(half_space(), 10, right_answers());
    EXPECT_EQ(found.depth.count, 2U);
    EXPECT_EQ(found.normal.count, 2U);
}

TEST(Errors, OfNormalsAreNotThoseOfParticlesOnTheSurfaceItself) {
    Truth truth = half_space();
    truth.distance[0] = 5e-6F;
    Answers answers = right_answers();
    answers.depth[0] = 5e-6F;
    answers.normal[0] = {0, 1, 0};
    const ErrorSummary errors = errors_of(truth, 1, answers);
    EXPECT_EQ(errors.normal.count, 1U);
    EXPECT_EQ(errors.normal.worst, 0);
    EXPECT_EQ(errors.depth.count, 2U);
}

TEST(Errors, CountAMissedParticleAsDepthZeroAndAnInventedOneAsAWrongSideAlone) {
    Answers answers = right_answers();
    answers.inside = {0, 1, 0, 1};
    answers.depth = {0, 2, 0, 7};
    const ErrorSummary errors = errors_of(half_space(), 10, answers);
    EXPECT_EQ(errors.wrong_share, 0.5);
    EXPECT_FLOAT_EQ(static_cast<float>(errors.farthest_wrong), 0.4F);
    EXPECT_FLOAT_EQ(static_cast<float>(errors.depth.worst),
                    0.4F); // the missed one; the invented has no depth
    EXPECT_FLOAT_EQ(static_cast<float>(errors.depth.mean), 0.2F);
    EXPECT_EQ(errors.normal.worst, 0); // of the one that was found
}

TEST(Errors, OfNormalsAreAnglesAndANormalThatIsMissingCountsAsARightOne) {
    Answers answers = right_answers();
    answers.normal[0] = {0, 1, 0};
    EXPECT_NEAR(errors_of(half_space(), 10, answers).normal.worst, 90, 1e-9);
    answers.normal[0] = {-1, 0, 0};
    EXPECT_NEAR(errors_of(half_space(), 10, answers).normal.worst, 180, 1e-9);
    answers.normal[0] = {};
    EXPECT_EQ(errors_of(half_space(), 10, answers).normal.worst, 90);
    answers.normal[0] = {1, 1e-5F, 0};
    EXPECT_NEAR(errors_of(half_space(), 10, answers).normal.worst, 5.73e-4, 1e-6);
}

TEST(Errors, AreThoseOfTheParticlesThatWereAskedAbout) {
    const Answers answers{{3, 0}, {1, 1}, {3, 5}, {{1, 0, 0}, {1, 0, 0}}};
    const ErrorSummary errors = errors_of(half_space(), 1, answers);
    EXPECT_EQ(errors.asked_count, 2U);
    EXPECT_EQ(errors.wrong_share, 0.5);
    EXPECT_EQ(errors.farthest_wrong, 3);
    EXPECT_EQ(errors.depth.mean, 1);
}

TEST(Errors, OfSignsAloneSayNothingOfDepths) {
    const Answers answers{{0, 1, 2, 3}, {0, 0, 0, 0}, {}, {}};
    const ErrorSummary errors = errors_of(half_space(), 1, answers);
    EXPECT_EQ(errors.wrong_share, 0.5);
    EXPECT_EQ(errors.depth.worst, 0);
}

TEST(Errors, AreNoWrongSidesOfParticlesThatTheTruthCannotPlace) {
    Answers answers = right_answers();
    answers.inside = {1, 0, 1, 1}; // at distances 2, 1 and 3
    EXPECT_EQ(errors_of(half_space(), 10, answers).wrong_share, 0.75);
    EXPECT_EQ(errors_of(half_space(), 10, answers, 0.15).wrong_share, 0.5);
    EXPECT_EQ(errors_of(half_space(), 10, answers, 1).wrong_share, 0);
}

TEST(Errors, BoundNinetyNineOfAHundred) {
    Truth truth;
    Answers answers;
    for (std::uint32_t i = 0; i < 201; ++i) {
        truth.inside.push_back(1);
        truth.distance.push_back(static_cast<float>(i));
        answers.asked.push_back(i);
        answers.inside.push_back(1);
        answers.depth.push_back(0);
        answers.normal.emplace_back();
    }
    const ErrorSummary errors = errors_of(truth, 1, answers);
    EXPECT_EQ(errors.depth.most, 198);
    EXPECT_EQ(errors.depth.worst, 200);
    EXPECT_NEAR(errors.depth.mean, 100, 1e-9);
}
