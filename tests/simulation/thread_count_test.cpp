// The same bits on any number of threads.

#include "support/kinds_of_simulations.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

TEST(ThreadCount, DecidesNoBits) {
    for (const KindOfSimulation& kind : kinds_of_simulations()) {
        SCOPED_TRACE(kind.name);
        Simulation one = kind.make(1), two = kind.make(2), three = kind.make(3);
        for (int i = 0; i < 60; ++i) {
            for (Simulation* simulation : {&one, &two, &three}) kind.step(*simulation);
            ASSERT_EQ(two.state_hash(), one.state_hash()) << i;
            ASSERT_EQ(three.state_hash(), one.state_hash()) << i;
        }
        // All that the next frames depend on.
        EXPECT_EQ(two.save_state(), one.save_state());
        EXPECT_EQ(three.save_state(), one.save_state());
    }
}

TEST(ThreadCount, MayChangeWithASavedStateOrACopy) {
    const KindOfSimulation kind = sheet_among_moving_colliders();
    Simulation one = kind.make(1), two = kind.make(2);
    for (int i = 0; i < 20; ++i) kind.step(one);
    two.restore_state(one.save_state());
    EXPECT_EQ(two.options().thread_count, 2u);
    Simulation copy = two;
    for (int i = 0; i < 20; ++i)
        for (Simulation* simulation : {&one, &two, &copy}) kind.step(*simulation);
    EXPECT_EQ(two.save_state(), one.save_state());
    EXPECT_EQ(copy.save_state(), one.save_state());
}
