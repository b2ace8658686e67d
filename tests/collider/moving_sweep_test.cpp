#include "support/random_points.hpp"

#include <echinus/collider.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace echinus;

namespace {

/// A collider that has just moved for one second, and its pose before.
struct Moved {
    Collider now;
    RigidTransform before;
};

Moved moved(const AnyMap& map, const Vec3d& scale, const Vec3d& linear, const Vec3d& angular) {
    Moved result{{.map = map,
                  .pose = {Rotation::about({1, 2, -1}, 0.7), {5, -3, 2}},
                  .scale = scale,
                  .linear_velocity = linear,
                  .angular_velocity = angular},
                 {}};
    result.before = result.now.pose;
    result.now.pose = pose_after(result.now, 1);
    return result;
}

/// The first of many sampled moments at which a particle is inside, or 2.
double first_inside(const Moved& scene, const Vec3f& from, const Vec3f& to, int moments) {
    Collider collider = scene.now;
    for (int i = 0; i <= moments; ++i) {
        const double t = double(i) / moments;
        collider.pose = scene.before;
        collider.pose = pose_after(collider, t);
        if (contains(collider, Vec3f(Vec3d(from) + (Vec3d(to) - Vec3d(from)) * t))) return t;
    }
    return 2;
}

} // namespace

TEST(MovingSweep, MeetsTheSurfaceWhenDenseSamplingInTimeDoes) {
    const ExactMap map = ExactMap::build(make_torus(1, 0.4, 30, 12));
    test::Random random(11);
    int met = 0;
    int unlike = 0;
    constexpr int kCount = 600;
    for (int n = 0; n < kCount; ++n) {
        const Vec3d scale = n % 2 == 0 ? Vec3d{1, 1, 1} : Vec3d{0.7, -1.5, 1};
        const Moved scene =
            moved(map, scale, Vec3d(test::in_cube(random, 1)), Vec3d(test::in_cube(random, 0.03F)));
        const auto place = [&] { return Vec3f(Vec3d(test::in_cube(random, 1.7F)) + Vec3d{5, -3, 2}); };
        const Vec3f from = place();
        const Vec3f to = place();
        Collider before = scene.now;
        before.pose = scene.before;
        if (contains(before, from)) continue;
        const SweepHit hit = sweep(scene.now, scene.before, from, to);
        const double sampled = first_inside(scene, from, to, 400);
        // Chord and path differ by 0.1 %, and a particle may graze a surface.
        if (hit.found() != (sampled <= 1) || std::fabs(hit.fraction - std::min(sampled, 1.0)) > 0.02) {
            ++unlike;
            continue;
        }
        if (!hit.found()) continue;
        ++met;
        EXPECT_TRUE(hit.entering);
        EXPECT_NEAR(std::fabs(contact(scene.now, hit.point, 0.01F).depth), 0, 1e-5);
        EXPECT_FALSE(contains(scene.now, hit.point + hit.normal * 1e-4F));
        EXPECT_TRUE(contains(scene.now, hit.point - hit.normal * 1e-4F));
    }
    EXPECT_GT(met, kCount / 4);
    EXPECT_LT(unlike, kCount / 50);
}

TEST(MovingSweep, MeetsAThinPlateThatPassesOverAParticleAtRest) {
    const ExactMap plate = ExactMap::build(make_box({1, 1, 0.001}));
    const Moved scene = moved(plate, {1, 1, 1}, {}, {0, 0, 0});
    Collider now = scene.now;
    const Vec3f particle(now.pose.to_world({0.1, 0.2, 0.5}));
    RigidTransform risen = now.pose;
    risen.translation += now.pose.rotation.apply({0, 0, 1});
    now.pose = risen;
    const SweepHit hit = sweep(now, scene.before, particle, particle);
    ASSERT_TRUE(hit.found());
    EXPECT_NEAR(hit.fraction, 0.4995, 1e-4);
    const Vec3d up = now.pose.rotation.apply({0, 0, 1});
    EXPECT_NEAR(length(Vec3d(hit.normal) - up), 0, 1e-5);
    EXPECT_NEAR(length(now.pose.to_local(Vec3d(hit.point)) - Vec3d{0.1, 0.2, 0.0005}), 0, 1e-5);
    EXPECT_FALSE(contains(now, particle)); // inside neither before nor after, only on the way
}

TEST(MovingSweep, MeetsNothingWhenParticleAndColliderMoveTogether) {
    const ExactMap map = ExactMap::build(make_box({1, 1, 0.001}));
    test::Random random(12);
    for (int n = 0; n < 200; ++n) {
        const Moved scene =
            moved(map, {1, 1, 1}, Vec3d(test::in_cube(random, 5)), Vec3d(test::in_cube(random, 3)));
        const Vec3d local{0.1, -0.2, 0.001};
        EXPECT_FALSE(sweep(scene.now, scene.before, Vec3f(scene.before.to_world(local)),
                           Vec3f(scene.now.pose.to_world(local)))
                         .found());
    }
}

TEST(MovingSweep, MeetsNothingWithADistanceMapOrWithPointsThatAreNotFinite) {
    const TriangleMesh box = make_box({1, 1, 1});
    const DistanceMap sampled = DistanceMap::build(box, {.longitude_count = 16, .colatitude_count = 16});
    const Vec3f far{9, 9, 9};
    const Vec3f centre{5, -3, 2};
    const Moved without = moved(sampled, {1, 1, 1}, {}, {});
    const SweepHit nothing = sweep(without.now, without.before, far, centre);
    EXPECT_FALSE(nothing.found());
    EXPECT_EQ(nothing.point, centre);
    EXPECT_EQ(nothing.fraction, 1);
    const Moved exact = moved(ExactMap::build(box), {1, 1, 1}, {}, {});
    EXPECT_TRUE(sweep(exact.now, exact.before, far, centre).found());
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(sweep(exact.now, exact.before, {kNaN, 0, 0}, centre).found());
    EXPECT_FALSE(sweep(exact.now, exact.before, far, {3e38F * 10, 0, 0}).found());
}
