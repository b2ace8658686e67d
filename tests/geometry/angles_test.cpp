#include "geometry/angles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace echinus;

TEST(Atan2Polynomial, AgreesWithTheLibraryAllAroundTheCircle) {
    for (int i = -200'000; i <= 200'000; ++i) {
        const double angle = i * 3.14159e-5 / 2;
        for (float scale : {1e-12F, 1.0F, 3e10F}) {
            const float x = scale * static_cast<float>(std::cos(angle));
            const float y = scale * static_cast<float>(std::sin(angle));
            ASSERT_NEAR(atan2_polynomial(y, x), std::atan2(static_cast<double>(y), static_cast<double>(x)),
                        4e-7);
        }
    }
}

TEST(Atan2Polynomial, IsExactOnTheAxesAndZeroAtTheOrigin) {
    EXPECT_EQ(atan2_polynomial(0, 0), 0);
    EXPECT_EQ(atan2_polynomial(0, 2), 0);
    EXPECT_EQ(atan2_polynomial(3, 0), kPi / 2);
    EXPECT_EQ(atan2_polynomial(-3, 0), -kPi / 2);
    EXPECT_EQ(atan2_polynomial(0, -1), kPi);
    EXPECT_EQ(atan2_polynomial(-0.0F, -1), -kPi);
}

TEST(CirclePoint, AgreesWithTheCosineAndSineOfTheLibrary) {
    for (std::uint64_t count : {1U, 3U, 7U, 8U, 24U, 200U, 1013U})
        for (std::uint64_t index = 0; index < 2 * count; ++index) {
            const double angle_rad =
                2 * std::numbers::pi * static_cast<double>(index % count) / static_cast<double>(count);
            const CirclePoint p = circle_point(index, count);
            ASSERT_NEAR(p.cosine, std::cos(angle_rad), 1.5e-15);
            ASSERT_NEAR(p.sine, std::sin(angle_rad), 1.5e-15);
        }
}

TEST(CirclePoint, IsExactlySymmetric) {
    for (std::uint64_t count : {3U, 24U, 61U})
        for (std::uint64_t index = 1; index < count; ++index) {
            const CirclePoint p = circle_point(index, count);
            const CirclePoint mirrored = circle_point(count - index, count);
            ASSERT_EQ(p.cosine, mirrored.cosine);
            ASSERT_EQ(p.sine, -mirrored.sine);
        }
}

TEST(CirclePoint, HasNoRoundingErrorAtQuarterTurns) {
    const double expected[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (std::uint64_t quarter = 0; quarter < 4; ++quarter) {
        EXPECT_EQ(circle_point(quarter * 25, 100).cosine, expected[quarter][0]);
        EXPECT_EQ(circle_point(quarter * 25, 100).sine, expected[quarter][1]);
    }
}
