#include "geometry/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

using namespace echinus;

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
