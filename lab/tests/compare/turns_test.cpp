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
