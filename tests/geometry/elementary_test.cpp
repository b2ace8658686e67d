// Logarithms and angles with the same bits on every machine, beside the C library's.

#include "geometry/elementary.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

using namespace echinus;
using namespace echinus::test;

TEST(Elementary, LogarithmsAreThoseOfTheCLibraryToRounding) {
    PortableRandom random(1);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.uniform(-1000, 1000)));
        EXPECT_NEAR(portable_log(x), std::log(x), 4e-16 * std::max(1.0, std::abs(std::log(x)))) << x;
        const double near_one = 1 + random.uniform(-1e-3, 1e-3);
        EXPECT_NEAR(portable_log(near_one), std::log(near_one), 4e-16 * std::abs(std::log(near_one)) + 1e-19);
    }
    EXPECT_EQ(portable_log(1), 0);
}

TEST(Elementary, AnglesAreThoseOfTheCLibraryToRounding) {
    PortableRandom random(2);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-8, 8))),
                     y = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-8, 8)));
        EXPECT_NEAR(portable_atan2(y, x), std::atan2(y, x), 1.8e-15) << y << ' ' << x;
    }
    EXPECT_EQ(portable_atan2(0, 1), 0);
    EXPECT_EQ(portable_atan2(0, 0), 0);
    EXPECT_EQ(portable_atan2(0, -1), std::numbers::pi);
    EXPECT_EQ(portable_atan2(-0.0, -1), -std::numbers::pi);
    EXPECT_EQ(portable_atan2(2, 0), std::numbers::pi / 2);
}

TEST(Elementary, HasTheSameBitsOnEveryMachine) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(portable_log(0.3)), 0xbff34378fcbda720u);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(portable_atan2(0.3, -0.7)), 0x4005e4c36ca0118au);
}
