#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

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

TEST(ColliderMotion, HeadsForAPoseAndGetsThere) {
    const RigidTransform goal{Rotation::about({3, -1, 2}, 2.9), {-1, 4, 0.5}};
    Collider collider = moving({9, 9, 9}, {7, 0, 0});
    head_for(collider, goal, 0.25);
    const RigidTransform halfway = pose_after(collider, 0.125), there = pose_after(collider, 0.25);
    for (const Vec3d& point : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(there.to_world(point) - goal.to_world(point)), 0, 1e-12);
    EXPECT_NEAR(length(halfway.translation - (collider.pose.translation + goal.translation) * 0.5), 0, 1e-12);
    EXPECT_LE(length(collider.angular_velocity), std::numbers::pi / 0.25);
}

TEST(ColliderMotion, GoesEvenlyFromKeyToKeyAndRestsBeyondThem) {
    const Vec3d axis{0.6, 0, 0.8};
    const std::vector<PoseKey> keys{{1, {Rotation::about(axis, 0.5), {0, 0, 0}}},
                                    {3, {Rotation::about(axis, 2.5), {4, 0, 2}}},
                                    {4, {Rotation::about(axis, -3.5), {4, 1, 2}}}};
    const auto expect_pose = [&](double time, double angle, const Vec3d& translation) {
        const RigidTransform pose = pose_at(keys, time);
        const RigidTransform expected{Rotation::about(axis, angle), translation};
        for (const Vec3d& point : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
            EXPECT_NEAR(length(pose.to_world(point) - expected.to_world(point)), 0, 1e-12) << time;
    };
    expect_pose(-10, 0.5, {0, 0, 0});
    expect_pose(1, 0.5, {0, 0, 0});
    expect_pose(1.5, 1, {1, 0, 0.5});
    expect_pose(2.75, 2.25, {3.5, 0, 1.75});
    expect_pose(3, 2.5, {4, 0, 2});
    // From 2.5 to -3.5 the shorter way leads up, to 2 pi - 3.5.
    expect_pose(3.5, (2.5 + 2 * std::numbers::pi - 3.5) / 2, {4, 0.5, 2});
    expect_pose(1e9, -3.5, {4, 1, 2});
}
