// Compiled optimised, as the libraries are, by tests/CMakeLists.txt.

#include <gtest/gtest.h>

#include <array>

/// Visible from elsewhere and not inlined, so that the compiler has to expect any numbers.
[[gnu::noinline]] void round_to_floats(const std::array<double, 2>& from, std::array<double, 2>& to) {
    const auto first = static_cast<float>(from[0]), second = static_cast<float>(from[1]);
    to[0] = first;
    to[1] = second;
}

// GCC 12 leaves out the rounding unless cmake/EchinusTargets.cmake forbids the optimisation that does so.
TEST(Arithmetic, RoundsNeighbouringDoublesThatBecomeFloatsAndDoublesAgain) {
    std::array<double, 2> rounded{};
    round_to_floats({0.1, 0.2}, rounded);
    EXPECT_EQ(rounded[0], static_cast<double>(0.1F));
    EXPECT_EQ(rounded[1], static_cast<double>(0.2F));
}
