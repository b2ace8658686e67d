#include "geometry/arena.hpp"

#include <gtest/gtest.h>

#include <numeric>

using namespace echinus;

TEST(Arena, KeepsWhatWasPutIntoItAsItGrows) {
    Arena<int> arena;
    for (int i = 0; i < 1000; ++i) arena.push_back(i);
    int* more = arena.room_for(5000);
    std::iota(more, more + 4000, 1000);
    arena.extend(4000);
    ASSERT_EQ(arena.size(), 5000u);
    for (int i = 0; i < 5000; ++i) EXPECT_EQ(arena[static_cast<std::size_t>(i)], i);
}

TEST(Arena, KeepsItsMemoryWhenItIsClearedOrMadeShorter) {
    Arena<int> arena;
    arena.reset(100);
    const int* memory = arena.data();
    arena.clear();
    EXPECT_TRUE(arena.empty());
    arena.reset(70);
    EXPECT_EQ(arena.size(), 70u);
    EXPECT_EQ(arena.data(), memory);
}
