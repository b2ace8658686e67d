#include "render/intersector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace echinus;

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
