#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#include <numbers>

using namespace echinus;

namespace {

Collider moving(const Vec3d& linear, const Vec3d& angular) {
    const DistanceMap map =
        DistanceMap::build(make_box({1, 1, 1}), {.longitude_count = 8, .colatitude_count = 4});
    return {.map = map,
            .pose = {Rotation::about({1, 1, 0}, 0.3), {5, 6, 7}},
            .linear_velocity = linear,
            .angular_velocity = angular};
}

/// The position after a time of a material point, given in the collider's local frame.
Vec3d material_point(Collider collider, const Vec3d& local, double seconds) {
    collider.pose = pose_after(collider, seconds);
    return collider.pose.to_world(local);
}

} // namespace

TEST(ColliderMotion, FollowsItsLinearVelocity) {
    const Vec3d moved = pose_after(moving({1, 2, 3}, {}), 0.5).translation;
    EXPECT_NEAR(length(moved - Vec3d{5.5, 7, 8.5}), 0, 1e-15);
}

TEST(ColliderMotion, TurnsAboutItsOwnTranslationInWorldAxes) {
    const Collider collider = moving({}, {0, 0, std::numbers::pi});
    const Vec3d before = collider.pose.to_world({1, 0, 0}) - collider.pose.translation;
    const Vec3d after = material_point(collider, {1, 0, 0}, 0.5) - collider.pose.translation;
    EXPECT_NEAR(length(after - Vec3d{-before.y, before.x, before.z}), 0, 1e-13);
}

TEST(ColliderMotion, InManySmallStepsEndsWhereOneLargeStepDoes) {
    Collider stepped = moving({0.3, -0.2, 0.1}, {0.5, 1, -2});
    const RigidTransform at_once = pose_after(stepped, 3);
    for (int i = 0; i < 3000; ++i) stepped.pose = pose_after(stepped, 0.001);
    for (const Vec3d& local : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(stepped.pose.to_world(local) - at_once.to_world(local)), 0, 1e-10);
}

TEST(ColliderMotion, HasTheVelocityOfItsMaterial) {
    const Collider collider = moving({0.3, -0.2, 0.1}, {0.5, 1, -2});
    const Vec3d local{0.4, -0.7, 0.2};
    constexpr double kSeconds = 1e-6;
    const Vec3d difference =
        (material_point(collider, local, kSeconds) - material_point(collider, local, -kSeconds)) *
        (1 / (2 * kSeconds));
    EXPECT_NEAR(length(velocity_at(collider, collider.pose.to_world(local)) - difference), 0, 1e-8);
    EXPECT_TRUE(collider.moves());
}

TEST(ColliderMotion, WithoutVelocityChangesNoBit) {
    const Collider collider = moving({}, {});
    const RigidTransform pose = pose_after(collider, 10);
    EXPECT_EQ(pose.translation, collider.pose.translation);
    EXPECT_EQ(pose.rotation.w, collider.pose.rotation.w);
    EXPECT_FALSE(collider.moves());
}
