#include "compare/measuring.hpp"
#include "compare/turns.hpp"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

using namespace echinus::comparison;

TEST(Turns, GoThereAndBackWithAWarmUpBeforeEachPart) {
    std::string calls;
    const auto named = [&calls](char name) {
        return [&calls, name](Part part) {
            calls += name;
            calls += std::to_string(part.begin) + '-' + std::to_string(part.end) + ' ';
        };
    };
    TurnOptions options;
    options.warm_up = 2;
    options.passes = 2;
    const std::vector<Pace> paces = take_turns({{named('a'), {{0, 4}}}, {named('b'), {{5, 8}}}}, options);
    EXPECT_EQ(calls, "a0-2 a0-4 b3-5 b5-8 b3-5 b5-8 a0-2 a0-4 ");
    ASSERT_EQ(paces.size(), 2U);
    EXPECT_EQ(paces[0].pass_ns.size(), 2U);
    EXPECT_GE(paces[0].ns, 0);
}

TEST(Turns, EndForWhoTookLongEnough) {
    int calls = 0;
    const auto slow = [&](Part) {
        ++calls;
        volatile double sum = 0;
        for (int i = 0; i < 1'000'000; ++i) sum = sum + i;
    };
    TurnOptions options;
    options.warm_up = 0;
    options.passes = 5;
    options.enough_seconds = 0;
    (void)take_turns({{slow, {{0, 10}}}}, options);
    EXPECT_EQ(calls, 2); // a warm-up of nothing and one turn
}

TEST(Turns, CountTheThreadsOfARacerWhereAsked) {
    const auto delegating = [](Part) {
        std::thread([] {
            volatile double sum = 0;
            for (int i = 0; i < 3'000'000; ++i) sum = sum + i;
        }).join();
    };
    TurnOptions options;
    options.passes = 1;
    const double alone = take_turns({{delegating, {{0, 1}}}}, options)[0].ns;
    options.all_threads = true;
    EXPECT_GT(take_turns({{delegating, {{0, 1}}}}, options)[0].ns, alone);
}

TEST(Turns, HaveTheMedianOfTheirPasses) {
    EXPECT_EQ(median_of({3, 1, 2}), 2);
    EXPECT_EQ(median_of({4, 1, 2, 3}), 2.5);
    EXPECT_TRUE(median_of({}) != median_of({}));
}

TEST(Turns, AskASlowRacerForPartsSpreadOverAll) {
    const auto quick = [](Part) {};
    ASSERT_EQ(parts_for(quick, 1'000'000, 1).size(), 1U);
    const auto slow = [](Part part) {
        volatile double sum = 0;
        for (std::size_t i = 0; i < 100 * part.size(); ++i) sum = sum + 1;
    };
    const std::vector<Part> parts = parts_for(slow, 1'000'000, 1e-6);
    ASSERT_EQ(parts.size(), 10U);
    EXPECT_EQ(parts.front().begin, 49'500U);
    EXPECT_EQ(parts.back().end, 950'500U);
    for (const Part& part : parts) EXPECT_EQ(part.size(), 1000U);
}

using namespace echinus;

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
