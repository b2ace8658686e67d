#include "geometry/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

using namespace echinus;

TEST(ParallelFor, VisitsEveryIndexOnceForAnyThreadCount) {
    for (unsigned thread_count : {0u, 1u, 2u, 7u}) {
        std::vector<std::atomic<int>> visits(10'007);
        parallel_for(visits.size(), thread_count, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& count : visits) ASSERT_EQ(count, 1);
    }
}

TEST(ParallelFor, CallsNothingForAnEmptyRange) {
    parallel_for(0, 0, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(ParallelFor, PassesOnTheExceptionOfItsBody) {
    EXPECT_THROW(parallel_for(100, 0, [](std::size_t, std::size_t) { throw std::runtime_error("body"); }),
                 std::runtime_error);
}
