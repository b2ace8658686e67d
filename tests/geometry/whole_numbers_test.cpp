#include "geometry/whole_numbers.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

using namespace echinus;

TEST(WholeNumbers, KeepWhatTheTypeHolds) {
    EXPECT_EQ(truncated_to<std::int32_t>(2147483647.9), INT32_MAX);
    EXPECT_EQ(truncated_to<std::int32_t>(-2147483648.0), INT32_MIN);
    EXPECT_EQ(truncated_to<std::uint16_t>(-0.9), 0);
    EXPECT_EQ(truncated_to<std::uint16_t>(65535.9F), 65535);
    EXPECT_EQ(truncated_to<std::int64_t>(-0x1p63), INT64_MIN);
    EXPECT_EQ(truncated_to<std::uint64_t>(0x1.fffffffffffffp63), 0xFFFF'FFFF'FFFF'F800);
    EXPECT_EQ(nearest_whole(0x1p62), std::int64_t{1} << 62);
    EXPECT_EQ(nearest_whole(2.5), 2);
    EXPECT_EQ(kept_as<std::uint32_t>(std::size_t{UINT32_MAX}), UINT32_MAX);
    EXPECT_EQ(packed<32>(UINT32_MAX, 7), 0xFFFF'FFFF'0000'0007);
    EXPECT_EQ(packed<16>(1, 0xFFFF), 0x1'FFFF);
}

#if !defined(NDEBUG) && !defined(__SANITIZE_THREAD__) // whose processes with threads do not fork
TEST(WholeNumbersDeathTest, StopTheProgramWhereTheTypeDoesNotHoldThem) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    EXPECT_DEATH(truncated_to<std::int32_t>(2147483648.0), "");
    EXPECT_DEATH(truncated_to<std::int32_t>(-2147483649.0), "");
    EXPECT_DEATH(truncated_to<std::uint16_t>(-1.0), "");
    EXPECT_DEATH(truncated_to<std::uint16_t>(65536.0F), "");
    EXPECT_DEATH(truncated_to<std::int64_t>(0x1p63), "");
    EXPECT_DEATH(truncated_to<std::int32_t>(kNaN), "");
    EXPECT_DEATH(nearest_whole(0x1p63), "");
    EXPECT_DEATH(nearest_whole(kNaN), "");
    EXPECT_DEATH(kept_as<std::uint32_t>(std::size_t{1} << 32), "");
    EXPECT_DEATH(kept_as<std::uint16_t>(-1), "");
    EXPECT_DEATH(packed<32>(1, std::uint64_t{1} << 32), "");
    EXPECT_DEATH(packed<16>(std::uint64_t{1} << 48, 0), "");
}
#endif
