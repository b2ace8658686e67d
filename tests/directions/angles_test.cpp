#include "directions/angles.hpp"

#include <gtest/gtest.h>

#include <cmath>

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
