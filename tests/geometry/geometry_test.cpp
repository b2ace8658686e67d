#include "geometry/arena.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/geometry.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

using namespace echinus;

TEST(Rotation, TurnsCounterClockwiseSeenAgainstTheAxis) {
    const Vec3d turned = Rotation::about({0, 0, 5}, std::numbers::pi / 2).apply({1, 0, 0});
    EXPECT_NEAR(turned.x, 0, 1e-15);
    EXPECT_NEAR(turned.y, 1, 1e-15);
    EXPECT_NEAR(turned.z, 0, 1e-15);
}

TEST(Rotation, AgreesWithSineAndCosineAtAnyAngle) {
    for (double angle = -20; angle < 20; angle += 0.37) {
        const Rotation rotation = Rotation::about({0, 3, 0}, angle);
        EXPECT_NEAR(rotation.w, std::cos(angle / 2), 1e-14) << angle;
        EXPECT_NEAR(rotation.y, std::sin(angle / 2), 1e-14) << angle;
    }
}

TEST(Rotation, GivesItsVectorTheShorterWayRound) {
    for (double angle = -20; angle < 20; angle += 0.37) {
        const Vec3d axis{2.0 / 3, -1.0 / 3, 2.0 / 3};
        const double shorter = std::remainder(angle, 2 * std::numbers::pi);
        const Vec3d vector = Rotation::about(axis, angle).vector();
        EXPECT_NEAR(length(vector - axis * shorter), 0, 1e-13) << angle;
    }
    EXPECT_EQ(Rotation{}.vector(), Vec3d{});
    EXPECT_NEAR(length(Rotation::about({1, 0, 0}, 1e-9).vector() - Vec3d{1e-9, 0, 0}), 0, 1e-14);
}

TEST(Rotation, ProductAppliesTheRightFactorFirst) {
    const Rotation a = Rotation::about({1, 2, 3}, 0.7);
    const Rotation b = Rotation::about({-2, 1, 0.5}, 1.9);
    const Vec3d v{0.3, -4, 2};
    const Vec3d together = (a * b).apply(v);
    const Vec3d apart = a.apply(b.apply(v));
    EXPECT_NEAR(length(together - apart), 0, 1e-14);
}

TEST(RigidTransform, ToLocalUndoesToWorldFarFromTheOrigin) {
    const RigidTransform pose{Rotation::about({1, -1, 2}, 2.5), {1e6, -3e6, 2e5}};
    const Vec3d point{0.25, -0.5, 0.75};
    EXPECT_NEAR(length(pose.to_local(pose.to_world(point)) - point), 0, 1e-8);
}

TEST(StridedSpan, WalksPositionsInsideAVertexStruct) {
    struct Vertex {
        float weight;
        Vec3f position;
        int colour;
    };
    const std::vector<Vertex> vertices{{0.5F, {1, 2, 3}, 7}, {0.25F, {4, 5, 6}, 8}};
    const StridedSpan<const Vec3f> positions(&vertices[0].position, vertices.size(), sizeof(Vertex));
    ASSERT_EQ(positions.size(), 2u);
    EXPECT_EQ(positions[1], (Vec3f{4, 5, 6}));
}

TEST(StridedSpan, ConvertsFromAVector) {
    std::vector<Vec3f> points{{1, 0, 0}, {2, 0, 0}};
    StridedSpan<const Vec3f> read = points;
    StridedSpan<Vec3f> write = points;
    write[1].x = 9;
    EXPECT_EQ(read[1].x, 9);
}

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
