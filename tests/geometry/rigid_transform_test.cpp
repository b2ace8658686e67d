#include <echinus/geometry.hpp>

#include <gtest/gtest.h>

#include <numbers>

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
