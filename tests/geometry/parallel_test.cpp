#include "geometry/parallel.hpp"
#include "geometry/workers.hpp"

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

TEST(ParallelForWorkers, LetsNoTwoCallsOfOneWorkerOverlap) {
    for (unsigned thread_count : {0u, 1u, 2u, 7u}) {
        std::vector<std::atomic<int>> busy(worker_count(thread_count));
        std::atomic<std::size_t> visited = 0;
        parallel_for_workers(5'000, thread_count,
                             [&](std::size_t worker, std::size_t begin, std::size_t end) {
                                 ASSERT_LT(worker, busy.size());
                                 EXPECT_EQ(busy[worker]++, 0);
                                 visited += end - begin;
                                 --busy[worker];
                             });
        EXPECT_EQ(visited, 5'000u);
    }
}

TEST(ParallelInvoke, CallsBothOnceAndPassesOnExceptions) {
    for (unsigned thread_count : {0u, 1u, 2u}) {
        std::atomic<int> first = 0, second = 0;
        parallel_invoke(
            thread_count, [&] { ++first; }, [&] { ++second; });
        EXPECT_EQ(first, 1);
        EXPECT_EQ(second, 1);
        EXPECT_THROW(parallel_invoke(
                         thread_count, [] {}, [] { throw std::runtime_error("second"); }),
                     std::runtime_error);
    }
}

TEST(ParallelFor, TakesMoreThreadsThanThereCanBe) {
    std::atomic<std::size_t> sum = 0;
    parallel_for(1000, 0xFFFF'FFFFU, [&](std::size_t begin, std::size_t end) { sum += end - begin; });
    EXPECT_EQ(sum, 1000U);
    EXPECT_LE(worker_count(0xFFFF'FFFFU), worker_count(0));
}

TEST(ForEachPiece, VisitsEveryIndexOnceForAnyThreadCount) {
    for (unsigned thread_count : {0U, 1U, 2U, 7U})
        for (std::size_t size : {0, 1, 100, 40'000, 100'003}) {
            std::vector<std::atomic<int>> visits(size);
            for_each_piece(size, thread_count, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++visits[i];
            });
            for (const auto& count : visits) ASSERT_EQ(count, 1);
        }
}

TEST(Workers, TakeEveryPieceOnceWhileOneOfThemDoesWhatWasOffered) {
    for (const unsigned thread_count : {1u, 2u, 4u}) {
        const Workers workers(thread_count);
        int times_done = 0; // by the end of the session, which waits for it
        std::vector<std::atomic<int>> visits(300);
        for (int frame = 1; frame <= 50; ++frame) {
            const int done_before = times_done;
            {
                const Workers::Session session(workers);
                workers.offer([&] { ++times_done; });
                for (int loop = 0; loop < 20; ++loop)
                    workers.for_pieces(visits.size(),
                                       [&](std::size_t, std::size_t piece) { ++visits[piece]; });
            }
            ASSERT_LE(times_done, done_before + 1);
            for (const auto& count : visits) ASSERT_EQ(count, 20 * frame);
        }
        if (workers.count() == 1) EXPECT_EQ(times_done, 0);
    }
}
