#include "geometry/arena.hpp"
#include "geometry/elementary.hpp"
#include "geometry/orientation.hpp"
#include "geometry/scratch.hpp"
#include "geometry/whole_numbers.hpp"
#include "support/random_points.hpp"

#include <echinus/geometry.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

using namespace echinus;
using echinus::test::PortableRandom;

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

using namespace echinus::test;

namespace {

__extension__ using Int = __int128;

int sign(Int x) {
    return (x > 0) - (x < 0);
}

Vec3<Int> whole(const Vec3f& p) {
    return {static_cast<Int>(p.x), static_cast<Int>(p.y), static_cast<Int>(p.z)};
}

/// A whole number of at most 24 bits, shifted: the differences of two need more bits than double has.
float wide_number(Random& random) {
    const int mantissa = std::uniform_int_distribution<int>(-(1 << 24), 1 << 24)(random);
    return std::ldexp(static_cast<float>(mantissa), std::uniform_int_distribution<int>(0, 13)(random));
}

Vec3f wide_point(Random& random) {
    const float x = wide_number(random), y = wide_number(random);
    return {x, y, wide_number(random)};
}

} // namespace

TEST(WideProduct, IsTheSameInTwoHalvesAsInOneNumber) {
    Random random(1);
    std::vector<std::int64_t> numbers;
    for (const std::int64_t least : {std::int64_t{0}, std::int64_t{1} << 31, std::int64_t{1} << 32,
                                     std::numeric_limits<std::int64_t>::max()})
        for (const std::int64_t away : {-1, 0, 1})
            numbers.insert(numbers.end(), {static_cast<std::int64_t>(std::uint64_t(least) + away),
                                           static_cast<std::int64_t>(-std::uint64_t(least) + away)});
    for (int i = 0; i < 100; ++i) numbers.push_back(static_cast<std::int64_t>(random()) >> i % 64);
    std::optional<std::pair<Int, portable::Int128>> last;
    for (const std::int64_t a : numbers)
        for (const std::int64_t b : numbers) {
            const Int product = Int{a} * b;
            const portable::Int128 halves = portable::wide_product(a, b);
            ASSERT_EQ(halves.high, static_cast<std::int64_t>(product >> 64)) << a << " * " << b;
            ASSERT_EQ(halves.low, static_cast<std::uint64_t>(product)) << a << " * " << b;
            if (last) ASSERT_EQ(halves < last->second, product < last->first) << a << " * " << b;
            last = {product, halves};
        }
}

TEST(Orientation, IsTheSignOfTheDeterminantInWholeNumbers) {
    Random random(1);
    for (int i = 0; i < 20'000; ++i) {
        const Vec3f a = wide_point(random), b = wide_point(random), d = wide_point(random);
        // Every other c lies in the plane of the others, or one unit beside it.
        const Vec3f c = i % 2 == 0 ? wide_point(random) : Vec3f(Vec3d(a) + Vec3d(b) - Vec3d(d));
        const Int volume = dot(whole(a) - whole(d), cross(whole(b) - whole(d), whole(c) - whole(d)));
        ASSERT_EQ(orientation(a, b, c, d), sign(volume));
        ASSERT_EQ(exact_orientation(a, b, c, d), sign(volume));
    }
}

TEST(Orientation, OfPointsOfAPlaneIsTheSignOfTheDeterminantInWholeNumbers) {
    Random random(2);
    for (int i = 0; i < 20'000; ++i) {
        const Vec3f p = wide_point(random), q = wide_point(random);
        const Point2 a{p.x, p.y}, b{q.x, q.y};
        const Point2 c{i % 2 == 0 ? p.z : float(2 * a.x - b.x), i % 2 == 0 ? q.z : float(2 * a.y - b.y)};
        const Int area = Int(a.x - c.x) * Int(b.y - c.y) - Int(a.y - c.y) * Int(b.x - c.x);
        ASSERT_EQ(orientation(a, b, c), sign(area));
        ASSERT_EQ(exact_orientation(a, b, c), sign(area));
    }
}

TEST(Orientation, DistinguishesTheSmallestFloatBesideTheLargest) {
    const float tiny = std::numeric_limits<float>::denorm_min(), huge = std::numeric_limits<float>::max();
    const Vec3f a{-huge, -huge, 0}, b{huge, -huge, 0}, c{0, huge, 0};
    EXPECT_EQ(orientation(a, b, c, {tiny, tiny, 0}), 0);
    EXPECT_EQ(orientation(a, b, c, {tiny, tiny, tiny}), -1);
    EXPECT_EQ(orientation(a, b, c, {tiny, tiny, -tiny}), 1);
    const Vec3f tilted_a{huge, -huge, tiny}, tilted_b{-huge, tiny, huge}, tilted_c{tiny, huge, -huge};
    EXPECT_EQ(orientation(tilted_a, tilted_b, tilted_c, {0, 0, tiny}), 0);
    EXPECT_EQ(orientation(tilted_a, tilted_b, tilted_c, {0, 0, 0}),
              -orientation(tilted_a, tilted_b, tilted_c, {tiny, 0, tiny}));
    EXPECT_NE(orientation(tilted_a, tilted_b, tilted_c, {0, 0, 0}), 0);
}

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
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double other : {0.0, 1.0, nan}) {
        EXPECT_TRUE(std::isnan(portable_atan2(nan, other))) << other;
        EXPECT_TRUE(std::isnan(portable_atan2(other, nan))) << other;
    }
}

TEST(Elementary, CubeRootsAreThoseOfTheCLibraryToRounding) {
    PortableRandom random(3);
    for (int i = 0; i < 100000; ++i) {
        const double x = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.uniform(-1000, 1000)));
        EXPECT_NEAR(portable_cbrt(x), std::cbrt(x), 8e-16 * std::cbrt(x)) << x;
    }
    EXPECT_EQ(portable_cbrt(0), 0);
    EXPECT_EQ(portable_cbrt(1), 1);
    EXPECT_EQ(portable_cbrt(8), 2);
    EXPECT_EQ(portable_cbrt(0x1p-30), 0x1p-10);
}

TEST(Elementary, HasTheSameBitsOnEveryMachine) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(portable_log(0.3)), 0xbff34378fcbda720u);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(portable_atan2(0.3, -0.7)), 0x4005e4c36ca0118au);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(portable_cbrt(0.3)), 0x3fe56bfea66ef78du);
}

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
