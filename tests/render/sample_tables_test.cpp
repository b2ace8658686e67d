#include "render/sample_sequence.hpp"

#include <gtest/gtest.h>

#include <vector>

using namespace echinus;

TEST(SampleTables, PutOneOfSixteenSamplesIntoEveryBoxOfEverySixteenth) {
    const SampleTables tables(16);
    for (std::uint32_t pixel = 0; pixel < 300; ++pixel) {
        const std::uint32_t seed = SampleTables::pixel_seed(pixel % 20, pixel / 20);
        for (SampleUse use : {SampleUse::Pixel, SampleUse::Lamp, SampleUse::Sky}) {
            for (int columns = 1; columns <= 16; columns *= 2) {
                std::vector<int> visits(16);
                for (std::uint32_t i = 0; i < 16; ++i) {
                    const Sample2 sample = tables.sample(i, use, seed);
                    const int column = static_cast<int>(sample[0] * static_cast<float>(columns));
                    const int row = static_cast<int>(sample[1] * (16.0F / static_cast<float>(columns)));
                    ++visits.at(static_cast<std::size_t>(row * columns + column));
                }
                for (int count : visits) ASSERT_EQ(count, 1);
            }
        }
    }
}

TEST(SampleTables, DrawOtherSamplesForNeighboursAndForOtherUses) {
    const SampleTables tables(8);
    const std::uint32_t seed = SampleTables::pixel_seed(5, 6);
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed),
              tables.sample(0, SampleUse::Sky, SampleTables::pixel_seed(6, 5)));
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed), tables.sample(0, SampleUse::Lamp, seed));
}

TEST(SampleTables, StayBelowOneForAnyCount) {
    const SampleTables tables(37);
    for (std::uint32_t i = 0; i < 37; ++i) {
        for (float part : tables.sample(i, SampleUse::Pixel, i * 7919)) {
            EXPECT_GE(part, 0);
            EXPECT_LT(part, 1);
        }
    }
}
