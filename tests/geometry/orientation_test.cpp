#include "geometry/orientation.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

using namespace echinus;
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
