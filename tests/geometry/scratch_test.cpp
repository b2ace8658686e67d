#include "geometry/scratch.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace echinus::test {
namespace {

TEST(Scratch, KeepsArraysApartInWhateverOrderTheyAreTakenAndGivenBack) {
    Scratch scratch;
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        std::vector<std::pair<std::uint32_t, ScratchVector<std::uint32_t>>> arrays;
        std::uint32_t next = 0;
        for (int turn = 0; turn < 200; ++turn) {
            if (!arrays.empty() && random() % 3 == 0) {
                const std::size_t gone = random() % arrays.size();
                std::swap(arrays[gone], arrays.back());
                arrays.pop_back();
            } else {
                ScratchVector<std::uint32_t> array(random() % 300 + 1, scratch);
                EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % Scratch::kAlignment, 0u);
                std::iota(array.begin(), array.end(), next);
                arrays.emplace_back(next, std::move(array));
                next += 1000;
            }
            for (const auto& [first, array] : arrays)
                for (std::uint32_t i = 0; i < array.size(); ++i) ASSERT_EQ(array[i], first + i);
        }
    }
}

TEST(Scratch, TakesTheSameMemoryAgainOnceItHasSeenTheMost) {
    Scratch scratch;
    const auto step = [&] {
        const ScratchVector<double> a(1000, scratch);
        const ScratchVector<double> b(500, scratch);
        return std::pair(a.data(), b.data());
    };
    step();
    const auto second = step();
    EXPECT_EQ(step(), second);
    EXPECT_LT(second.second - second.first, 1100);
}

} // namespace
} // namespace echinus::test
