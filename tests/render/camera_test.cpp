#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace echinus;

namespace {

/// Where a camera sees a point: x and y from the middle of the picture, in half heights.
std::array<double, 2> project(const Camera& camera, const Vec3f& point) {
    const Vec3d relative = Vec3d(point) - camera.position;
    const double depth = dot(relative, camera.forward) * camera.tan_half_height;
    return {dot(relative, camera.right) / depth, dot(relative, camera.up) / depth};
}

std::vector<Vec3f> random_points(std::mt19937& random, std::size_t count) {
    std::normal_distribution<float> normal;
    const Vec3f stretch{std::exp(normal(random)), std::exp(normal(random)), std::exp(normal(random))};
    const Vec3f offset{100 * normal(random), 100 * normal(random), 100 * normal(random)};
    std::vector<Vec3f> points(count);
    for (Vec3f& point : points) {
        point = offset +
                Vec3f{stretch.x * normal(random), stretch.y * normal(random), stretch.z * normal(random)};
    }
    return points;
}

} // namespace

TEST(Camera, ShowsAllPointsWithinTheMarginAndNoSmallerThanItMust) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    for (int round = 0; round < 200; ++round) {
        const std::vector<Vec3f> points = random_points(random, 40);
        View view;
        view.up = {share(random) - 0.5, share(random) - 0.5, share(random) - 0.5};
        view.azimuth_deg = 360 * share(random);
        view.elevation_deg = 170 * share(random) - 85;
        view.margin = 0.3 * share(random);
        view.footer = 0.2 * share(random);
        const double aspect = 1 + share(random);
        const Camera camera = camera_for(points, view, aspect);

        double widest = -10;
        double highest = -10;
        double lowest = -10;
        const double upper = 1 - 2 * view.margin;
        const double lower = upper - 2 * view.footer;
        for (const Vec3f& point : points) {
            const auto [x, y] = project(camera, point);
            widest = std::max(widest, std::abs(x) - (aspect - 2 * view.margin));
            highest = std::max(highest, y - upper);
            lowest = std::max(lowest, -y - lower);
        }
        // Nothing reaches into the border, and the width or the height is used fully.
        EXPECT_LT(std::max({widest, highest, lowest}), 1e-4);
        EXPECT_GT(std::max(widest, std::min(highest, lowest)), -1e-4);
    }
}

TEST(Camera, StandsOnTheSideThatTheViewNames) {
    const std::vector<Vec3f> points{{-1, -1, -1}, {1, 1, 1}};
    View view;
    view.azimuth_deg = 0;
    view.elevation_deg = 0;
    view.up = {0, 0, 1};
    EXPECT_GT(camera_for(points, view, 1).position.x, 2);
    view.up = {0, 3, 0};
    EXPECT_GT(camera_for(points, view, 1).position.z, 2);
    view.up = {1, 0, 0};
    EXPECT_GT(camera_for(points, view, 1).position.y, 2);
    view.up = {0, 0, 1};
    view.azimuth_deg = 90;
    EXPECT_GT(camera_for(points, view, 1).position.y, 2);
    view.elevation_deg = 89;
    EXPECT_GT(camera_for(points, view, 1).position.z, 2);
}

TEST(Camera, HasARightHandedBasisThatStandsUpright) {
    const std::vector<Vec3f> points{{-1, -2, -1}, {1, 1, 4}};
    const Camera camera = camera_for(points, View{}, 1.5);
    EXPECT_NEAR(length(cross(camera.right, camera.up) + camera.forward), 0, 1e-12);
    EXPECT_NEAR(dot(camera.right, camera.world_up), 0, 1e-12);
    EXPECT_GT(dot(camera.up, camera.world_up), 0);
}

TEST(Camera, PutsTheFloorUnderTheLowestPoint) {
    const std::vector<Vec3f> points{{0, 5, 1}, {2, -3, 0}, {1, 1, 1}};
    View view;
    view.up = {0, 2, 0};
    EXPECT_EQ(camera_for(points, view, 1).floor_height, -3);
}

TEST(Camera, RefusesWhatItCannotFrame) {
    const std::vector<Vec3f> points{{0, 0, 0}, {1, 0, 0}};
    const auto refuses = [&](const View& view, double aspect, std::span<const Vec3f> seen) {
        EXPECT_THROW(camera_for(seen, view, aspect), Error);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refuses({.up = {0, 0, 0}}, 1, points);
    refuses({.up = {nan, 0, 1}}, 1, points);
    refuses({.elevation_deg = 90}, 1, points);
    refuses({.azimuth_deg = nan}, 1, points);
    refuses({.vertical_field_deg = 0}, 1, points);
    refuses({.margin = 0.5}, 1, points);
    refuses({.footer = 0.5}, 1, points);
    refuses({}, 0, points);
    refuses({}, nan, points);
    refuses({}, 1, {});
    refuses({}, 1, std::vector<Vec3f>{{1, 2, 3}, {1, 2, 3}});
    refuses({}, 1, std::vector<Vec3f>{{1, 2, 3}, {1, std::numeric_limits<float>::infinity(), 3}});
}
