#include "render/intersector.hpp"
#include "render/light.hpp"

#include <echinus/error.hpp>
#include <echinus_render/render.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace echinus;
using namespace echinus::render;

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

namespace {

RayHit first_hit(const Intersector& intersector, const Ray& ray) {
    RayHit hit;
    intersector.first_hits({&ray, 1}, {&hit, 1});
    return hit;
}

} // namespace

TEST(Intersector, FindsTheNearSideOfABoxAtItsDistance) {
    const TriangleMesh box = make_box({2, 2, 2});
    const Intersector intersector(box);
    const RayHit hit = first_hit(intersector, {{5, 0.25F, 0.5F}, {-1, 0, 0}});
    ASSERT_TRUE(hit.found());
    EXPECT_NEAR(hit.distance, 4, 1e-5);
    for (std::uint32_t vertex : box.faces[hit.face]) EXPECT_EQ(box.vertices[vertex].x, 1);
}

TEST(Intersector, GivesBarycentricCoordinatesOfTheHitPoint) {
    const TriangleMesh box = make_box({2, 2, 2});
    const RayHit hit = first_hit(Intersector(box), {{5, 0.25F, 0.5F}, {-1, 0, 0}});
    ASSERT_TRUE(hit.found());
    const Triangle& face = box.faces[hit.face];
    const Vec3f point = box.vertices[face[0]] * (1 - hit.u - hit.v) + box.vertices[face[1]] * hit.u +
                        box.vertices[face[2]] * hit.v;
    EXPECT_NEAR(length(point - Vec3f{1, 0.25F, 0.5F}), 0, 1e-5);
}

TEST(Intersector, SeesASphereExactlyWhereTheFormulaSaysSo) {
    const Intersector intersector(make_sphere(1, 200, 100));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> position(-1.2F, 1.2F);
    for (int i = 0; i < 2000; ++i) {
        const Ray ray{{position(random), position(random), 4}, {0, 0, -1}};
        const float distance_sq = ray.origin.x * ray.origin.x + ray.origin.y * ray.origin.y;
        if (std::abs(distance_sq - 1) < 0.01F) continue; // facets differ from the sphere at its rim
        const RayHit hit = first_hit(intersector, ray);
        ASSERT_EQ(hit.found(), distance_sq < 1);
        if (hit.found()) EXPECT_NEAR(hit.distance, 4 - std::sqrt(1 - distance_sq), 0.01);
        EXPECT_EQ(intersector.blocked({&ray, 1}), distance_sq < 1 ? 1U : 0U);
    }
}

TEST(Intersector, AnswersEveryRayOfAPacketForItself) {
    const Intersector intersector(make_box({2, 2, 2}));
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < Intersector::kPacketSize; ++i) {
        rays.push_back({{i % 3 == 0 ? 5.0F : 0.1F, 0.2F, 7}, {0, 0, -1}}); // every third passes by
    }
    std::vector<RayHit> hits(rays.size());
    intersector.first_hits(rays, hits);
    const std::uint32_t blocked = intersector.blocked(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        EXPECT_EQ(hits[i].found(), i % 3 != 0);
        EXPECT_EQ((blocked >> i & 1U) != 0, i % 3 != 0);
    }
}

TEST(Intersector, LetsNoRaySlipThroughEdgesAndVertices) {
    const TriangleMesh sphere = make_sphere(1, 24, 12);
    const Intersector intersector(sphere);
    for (const Triangle& face : sphere.faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f& a = sphere.vertices[face[k]];
            const Vec3f middle = (a + sphere.vertices[face[(k + 1) % 3]]) * 0.5F;
            EXPECT_TRUE(first_hit(intersector, {{}, a}).found());
            EXPECT_TRUE(first_hit(intersector, {{}, middle}).found());
        }
    }
}

TEST(SampleTables, PutOneOfSixteenSamplesIntoEveryBoxOfEverySixteenth) {
    const SampleTables tables(16);
    for (std::uint32_t pixel = 0; pixel < 300; ++pixel) {
        const std::uint32_t seed = SampleTables::pixel_seed(pixel % 20, pixel / 20);
        for (SampleUse use : {SampleUse::Pixel, SampleUse::Lamp, SampleUse::Sky}) {
            for (int columns = 1; columns <= 16; columns *= 2) {
                std::vector<int> visits(16);
                for (std::uint32_t i = 0; i < 16; ++i) {
                    const Sample2 sample = tables.sample(i, use, seed);
                    const int column = static_cast<int>(sample[0] * static_cast<float>(columns));
                    const int row = static_cast<int>(sample[1] * (16.0F / static_cast<float>(columns)));
                    ++visits.at(static_cast<std::size_t>(row * columns + column));
                }
                for (int count : visits) ASSERT_EQ(count, 1);
            }
        }
    }
}

TEST(SampleTables, DrawOtherSamplesForNeighboursAndForOtherUses) {
    const SampleTables tables(8);
    const std::uint32_t seed = SampleTables::pixel_seed(5, 6);
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed),
              tables.sample(0, SampleUse::Sky, SampleTables::pixel_seed(6, 5)));
    EXPECT_NE(tables.sample(0, SampleUse::Sky, seed), tables.sample(0, SampleUse::Lamp, seed));
}

TEST(SampleTables, StayBelowOneForAnyCount) {
    const SampleTables tables(37);
    for (std::uint32_t i = 0; i < 37; ++i) {
        for (float part : tables.sample(i, SampleUse::Pixel, i * 7919)) {
            EXPECT_GE(part, 0);
            EXPECT_LT(part, 1);
        }
    }
}

namespace {

Camera some_camera() {
    return camera_for(std::vector<Vec3f>{{-1, -1, -1}, {1, 1, 1}}, View{}, 1);
}

} // namespace

TEST(StudioLight, ComesFromAboveTheCamerasLeftShoulder) {
    const Camera camera = some_camera();
    const StudioLight light(camera);
    for (const Sample2& sample : {Sample2{0, 0}, Sample2{0.5F, 0.5F}, Sample2{0.99F, 0.2F}}) {
        const Vec3d direction(light.lamp_direction(sample));
        EXPECT_LT(dot(direction, camera.right), 0);
        EXPECT_GT(dot(direction, camera.world_up), 0);
        EXPECT_LT(dot(direction, camera.forward), 0);
    }
}

TEST(StudioLight, IsBrighterFromTheSkyThanFromTheFloor) {
    const StudioLight light(some_camera());
    EXPECT_GT(light.ambient_radiance(light.up()).y, light.ambient_radiance(-light.up()).y);
    EXPECT_EQ(light.lamp_irradiance(-light.up()), Vec3f{});
}

TEST(CosineDirection, IsUnitAndFollowsTheCosine) {
    // Under a density of cos / pi the mean of the cosine over the hemisphere is 2/3, of its square 1/2.
    for (const Vec3f& normal : {Vec3f{0, 0, 1}, Vec3f{0, 0, -1}, Vec3f{0.6F, 0, 0.8F}, Vec3f{0, -1, 0}}) {
        double sum = 0;
        double sum_of_squares = 0;
        constexpr int kSide = 64;
        for (int i = 0; i < kSide * kSide; ++i) {
            const Sample2 sample{(static_cast<float>(i % kSide) + 0.5F) / kSide,
                                 (static_cast<float>(i / kSide) + 0.5F) / kSide};
            const Vec3f direction = cosine_direction(normal, sample);
            ASSERT_NEAR(length(direction), 1, 1e-5);
            const double cosine = dot(direction, normal);
            ASSERT_GE(cosine, -1e-6);
            sum += cosine;
            sum_of_squares += cosine * cosine;
        }
        EXPECT_NEAR(sum / (kSide * kSide), 2.0 / 3, 2e-3);
        EXPECT_NEAR(sum_of_squares / (kSide * kSide), 0.5, 2e-3);
    }
}
