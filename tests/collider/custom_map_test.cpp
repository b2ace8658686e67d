#include "support/custom_maps.hpp"
#include "support/random_points.hpp"

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

using namespace echinus;

namespace {

const RigidTransform kPose{Rotation::about({3, -1, 2}, 1.1), {10, -20, 30}};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Collider ball_collider(const Vec3d& scale) {
    return {.map = std::make_shared<test::AnalyticBall>(1.0F), .pose = kPose, .scale = scale};
}

/// More points than one call takes.
std::vector<Vec3f> points_about_pose(double reach) {
    test::Random random(7);
    std::vector<Vec3f> points;
    for (int i = 0; i < 5000; ++i)
        points.emplace_back(kPose.to_world(Vec3d(test::in_cube(random, static_cast<float>(reach)))));
    return points;
}

bool same(const Contact& a, const Contact& b) {
    return a.point == b.point && a.normal == b.normal && a.depth == b.depth && a.inside == b.inside;
}

} // namespace

TEST(CustomMap, AnswersInTheWorldLikeABallOfThatSizeThere) {
    const Collider collider = ball_collider({2, 2, 2});
    constexpr float kMargin = 0.5F;
    int inside = 0, near = 0;
    for (const Vec3f& point : points_about_pose(3)) {
        const Vec3d from_centre = Vec3d(point) - kPose.translation;
        const double distance = length(from_centre);
        if (std::fabs(distance - 2) < 1e-4 || std::fabs(distance - 2.5) < 1e-4) continue;
        const Contact found = contact(collider, point, kMargin);
        ASSERT_EQ(contains(collider, point), distance < 2);
        ASSERT_EQ(found.inside, distance < 2);
        ASSERT_EQ(found.found(), distance < 2.5);
        if (!found.found()) {
            ASSERT_EQ(found.point, point);
            continue;
        }
        ++(found.inside ? inside : near);
        ASSERT_NEAR(found.depth, 2 - distance, 2e-5);
        ASSERT_NEAR(length(Vec3d(found.point) - kPose.translation), 2, 2e-5);
        ASSERT_NEAR(dot(Vec3d(found.normal), from_centre) / distance, 1, 1e-5);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(near, 100);
}

TEST(CustomMap, IsAnEllipsoidUnderAStretchWithPointsOnItAndNormalsOfIt) {
    const Vec3d scale{0.5, -3, 1.2};
    const Collider collider = ball_collider(scale);
    int found_count = 0;
    for (const Vec3f& point : points_about_pose(3)) {
        const Contact found = contact(collider, point, 0.2F);
        if (!found.found()) continue;
        ++found_count;
        const Vec3d on_surface = kPose.to_local(Vec3d(found.point));
        const Vec3d in_ball{on_surface.x / scale.x, on_surface.y / scale.y, on_surface.z / scale.z};
        ASSERT_NEAR(length(in_ball), 1, 2e-5);
        const Vec3d gradient{in_ball.x / scale.x, in_ball.y / scale.y, in_ball.z / scale.z};
        const Vec3d normal = kPose.rotation.inverse().apply(Vec3d(found.normal));
        ASSERT_NEAR(dot(normal, gradient) / length(gradient), 1, 1e-4);
        ASSERT_NEAR(std::fabs(found.depth), length(Vec3d(found.point) - Vec3d(point)), 2e-5);
        ASSERT_EQ(found.inside, found.depth > 0);
    }
    EXPECT_GT(found_count, 100);
}

TEST(CustomMap, AnswersABatchAsOneByOne) {
    for (const Vec3d& scale : {Vec3d{1, 1, 1}, Vec3d{1, 2, -0.5}}) {
        const Collider collider = ball_collider(scale);
        const std::vector<Vec3f> points = points_about_pose(2);
        std::vector<std::uint8_t> inside(points.size(), 7);
        std::vector<Contact> contacts(points.size());
        contains_batch(collider, std::span(points), inside);
        contacts_batch(collider, std::span(points), 0.1F, contacts);
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(inside[i], contains(collider, points[i]) ? 1 : 0);
            ASSERT_TRUE(same(contacts[i], contact(collider, points[i], 0.1F)));
        }
    }
}

TEST(CustomMap, GivesNoContactWhereItsAnswerIsNotFinite) {
    const Vec3f point{1, 2, 3};
    for (const float bad : {kNaN, kInfinity, -kInfinity})
        for (int k = 0; k < 3; ++k) {
            Contact answer{.point = {1, 1, 1}, .normal = {0, 0, 1}, .depth = 0.5F, .inside = true};
            (k == 0 ? answer.point.y : k == 1 ? answer.normal.x : answer.depth) = bad;
            const Collider collider{.map = std::make_shared<test::ConstantAnswer>(answer)};
            const Contact found = contact(collider, point, 1);
            EXPECT_FALSE(found.found());
            EXPECT_EQ(found.point, point);
            EXPECT_EQ(found.depth, 0);
        }
}

TEST(CustomMap, HasUnitNormalsWhateverLengthItGivesThem) {
    for (const float size : {1e-12F, 0.3F, 1e12F}) {
        const Contact answer{.point = {}, .normal = {0, size, 0}, .depth = 0.5F, .inside = true};
        for (const Vec3d& scale : {Vec3d{1, 1, 1}, Vec3d{1, 2, -0.5}}) {
            const Collider collider{.map = std::make_shared<test::ConstantAnswer>(answer), .scale = scale};
            EXPECT_EQ(contact(collider, {1, 2, 3}).normal, (Vec3f{0, 1, 0}));
        }
    }
}

TEST(CustomMap, IsIgnoredForPointsThatAreNotFinite) {
    const Contact answer{.point = {}, .normal = {0, 1, 0}, .depth = 0.5F, .inside = true};
    const Collider collider{.map = std::make_shared<test::ConstantAnswer>(answer)};
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        EXPECT_FALSE(contains(collider, {0, bad, 0}));
        EXPECT_FALSE(contact(collider, {0, bad, 0}, 1).found());
    }
    EXPECT_TRUE(contains(collider, {0, 0, 0}));
}

TEST(CustomMap, HasNoSweep) {
    const Collider collider{.map = std::make_shared<test::AnalyticBall>(1.0F)};
    EXPECT_FALSE(sweep(collider, collider.pose, {-2, 0, 0}, {2, 0, 0}).found());
}
