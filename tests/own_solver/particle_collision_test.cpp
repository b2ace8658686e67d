// Collision for a solver of one's own. Whether a particle is lost is judged from outside: by contains() and
// sweep() of the collider, from where the particle was before a step to where it is after it.

#include "support/custom_maps.hpp"
#include "support/expectations.hpp"
#include "support/random_points.hpp"

#include <echinus/particle_collision.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

using namespace echinus;

namespace {

constexpr double kParticleThickness = 0.01;
constexpr double kParticleSeconds = 1.0 / 60;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A solver that knows no collision: particles with velocities, and a force on all.
struct Cloud {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> velocities = std::vector<Vec3f>(positions.size());
    std::vector<float> inverse_masses = std::vector<float>(positions.size(), 1);
    std::vector<Vec3f> previous = positions;

    void move(const Vec3f& acceleration = {}) {
        previous = positions;
        for (std::size_t i = 0; i < positions.size(); ++i) {
            velocities[i] += acceleration * float(kParticleSeconds);
            positions[i] += velocities[i] * float(kParticleSeconds);
        }
    }
    std::vector<std::uint32_t> correct(ParticleCollision& collision) {
        const auto corrected =
            collision.correct({previous, positions, velocities, inverse_masses}, kParticleSeconds);
        return {corrected.begin(), corrected.end()};
    }
    void step(ParticleCollision& collision, const Vec3f& acceleration = {}) {
        move(acceleration);
        correct(collision);
    }
};

Cloud cloud_in_cube(test::Random& random, int count, float half_width, const Vec3f& middle = {}) {
    std::vector<Vec3f> places;
    for (int i = 0; i < count; ++i) places.push_back(middle + test::in_cube(random, half_width));
    return {places};
}

/// Of the particles that were outside before a step, those inside or behind a surface after it.
std::size_t lost_count(const Cloud& cloud, const std::vector<Collider>& before,
                       const std::vector<Collider>& after) {
    std::size_t lost = 0;
    for (std::size_t c = 0; c < before.size(); ++c)
        for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
            if (contains(before[c], cloud.previous[i])) continue;
            const SweepHit hit = sweep(after[c], before[c].pose, cloud.previous[i], cloud.positions[i]);
            lost += hit.found() || contains(after[c], cloud.positions[i]) ? 1 : 0;
        }
    return lost;
}

RigidTransform random_pose(test::Random& random, float reach) {
    return {Rotation::about(Vec3d(test::unit_vector(random)), double{test::uniform(random, 0, 1)}),
            Vec3d(test::in_cube(random, reach))};
}

} // namespace

TEST(ParticleCollision, LeavesParticlesAloneThatMeetNothing) {
    test::Random random(1);
    ParticleCollision collision(
        {{.map = ExactMap::build(make_torus(1, 0.4, 24, 12)), .pose = {Rotation{}, {10, 0, 0}}}},
        kParticleThickness);
    Cloud cloud = cloud_in_cube(random, 200, 1.5F);
    for (int n = 0; n < 20; ++n) {
        for (Vec3f& velocity : cloud.velocities) velocity = test::in_cube(random, 3);
        cloud.move();
        const Cloud sent = cloud;
        EXPECT_TRUE(cloud.correct(collision).empty());
        EXPECT_EQ(cloud.positions, sent.positions);
        EXPECT_EQ(cloud.velocities, sent.velocities);
    }
}

TEST(ParticleCollision, SaysWhichParticlesItHasCorrectedAndLeavesTheOthersToTheBit) {
    test::Random random(2);
    ParticleCollision collision({{.map = ExactMap::build(make_torus(1, 0.4, 24, 12))}}, kParticleThickness);
    Cloud cloud = cloud_in_cube(random, 1000, 1.5F);
    std::size_t corrected_count = 0;
    for (int n = 0; n < 20; ++n) {
        for (Vec3f& velocity : cloud.velocities) velocity = test::in_cube(random, 30);
        cloud.move();
        const Cloud sent = cloud;
        const std::vector<std::uint32_t> corrected = cloud.correct(collision);
        std::vector<std::uint32_t> moved;
        for (std::uint32_t i = 0; i < 1000; ++i) {
            if (cloud.positions[i] != sent.positions[i])
                moved.push_back(i);
            else
                EXPECT_EQ(cloud.velocities[i], sent.velocities[i]);
        }
        EXPECT_EQ(corrected, moved);
        corrected_count += corrected.size();
    }
    EXPECT_GT(corrected_count, 1000u);
}

TEST(ParticleCollision, LosesNoParticleHoweverFastBetweenModelsThatMoveAndTurn) {
    test::Random random(3);
    const ExactMap torus = ExactMap::build(make_torus(1, 0.4, 30, 12));
    const ExactMap plate = ExactMap::build(make_box({2, 2, 0.001}));
    for (int n = 0; n < 8; ++n) {
        const std::vector<Collider> colliders{
            {.map = torus, .scale = n % 2 == 0 ? Vec3d{1, 1, 1} : Vec3d{0.5, -1.5, 1}},
            {.map = plate, .pose = {Rotation{}, {6, 0, 0}}}};
        ParticleCollision collision(colliders, n % 4 == 0 ? 0 : kParticleThickness);
        Cloud cloud = cloud_in_cube(random, 300, 1.5F);
        for (std::size_t i = 0; i < 150; ++i) cloud.positions[i] += Vec3f{6, 0, 0};
        for (int step = 0; step < 30; ++step) {
            for (Vec3f& velocity : cloud.velocities) velocity += test::in_cube(random, 100);
            cloud.move();
            const std::vector<Collider> before = collision.colliders();
            for (std::size_t c = 0; c < 2; ++c) {
                RigidTransform pose = random_pose(random, 0.5F);
                if (c == 1) pose.translation.x += 6;
                collision.set_collider_pose(c, pose);
            }
            cloud.correct(collision);
            EXPECT_EQ(lost_count(cloud, before, collision.colliders()), 0u);
            for (std::size_t i = 0; i < 300; ++i) // back to where the models are
                if (length(cloud.positions[i]) > 9) cloud.velocities[i] = cloud.positions[i] * -30;
        }
        EXPECT_EQ(collision.lost_count(), 0u);
    }
}

TEST(ParticleCollision, MissesNoColliderThatComesFromAfarOrIntoWhichAnotherOnePushes) {
    // A plate that was far away for some steps, moving, passes the particle in one; then it pushes the
    // particle to where another stands, which no particle was near.
    const ExactMap plate = ExactMap::build(make_box({2, 2, 0.01}));
    ParticleCollision collision({{.map = plate, .pose = {Rotation{}, {0, 0, -500}}},
                                 {.map = plate, .pose = {Rotation{}, {0, 0, 40}}}},
                                kParticleThickness);
    Cloud cloud{{{0.3F, 0.2F, 0}}};
    for (int n = 1; n <= 3; ++n) {
        collision.set_collider_pose(0, {Rotation::about({0, 0, 1}, n), {0, 0, -500.0 + 100 * n}});
        cloud.velocities[0] = {};
        cloud.step(collision);
        EXPECT_EQ(cloud.positions[0].z, 0);
    }
    collision.set_collider_pose(0, {Rotation{}, {0, 0, 30}});
    cloud.step(collision);
    EXPECT_NEAR(cloud.positions[0].z, 30.005 + kParticleThickness, 1e-3);
    cloud.velocities[0] = {};
    collision.set_collider_pose(0, {Rotation{}, {0, 0, 39.985}});
    cloud.step(collision);
    EXPECT_EQ(collision.lost_count(), 1u); // between the two is less room than the thickness
}

TEST(ParticleCollision, StopsAFastParticleOnAThinPlateWithTheVelocityThatIsLeft) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.001}))}}, kParticleThickness,
                                {.friction = 0});
    Cloud cloud{{{0.1F, 0.2F, 1}, {5, 5, 1}}};
    cloud.velocities = {{12, 0, -3000}, {0, 0, -3000}};
    cloud.move();
    EXPECT_EQ(cloud.correct(collision), std::vector<std::uint32_t>{0});
    EXPECT_NEAR(cloud.positions[0].z, 0.0005 + kParticleThickness, 1e-4);
    EXPECT_NEAR(cloud.velocities[0].x, 12, 1e-3);
    EXPECT_NEAR(cloud.velocities[0].z, 0, 1e-3);
    EXPECT_EQ(cloud.velocities[1].z, -3000);
}

TEST(ParticleCollision, TakesOfAnImpactTheShareOfFrictionThatCoulombGivesItWhereverTheStepMeetsIt) {
    for (const float height : {0.52F, 0.6F, 0.7F}) {
        ParticleCollision collision({{.map = ExactMap::build(make_box({8, 8, 1}))}}, kParticleThickness,
                                    {.friction = 0.25});
        Cloud cloud{{{0, 0, height}}};
        cloud.velocities = {{20, 0, -16}};
        cloud.step(collision);
        EXPECT_NEAR(cloud.velocities[0].x, 20 - 0.25 * 16, 1e-2) << height;
        EXPECT_NEAR(cloud.velocities[0].z, 0, 1e-3);
    }
}

TEST(ParticleCollision, SlidesDownASlopeAsCoulombHasItAndStaysOnAFlatterOne) {
    const ExactMap box = ExactMap::build(make_box({40, 40, 1}));
    const double angle = 0.5; // its tangent is 0.546
    const Rotation tilt = Rotation::about({1, 0, 0}, angle);
    for (const double friction : {0.0, 0.2, 0.4, 0.6}) {
        ParticleCollision collision({{.map = box, .pose = {tilt, {}}}}, kParticleThickness,
                                    {.friction = friction});
        Cloud cloud{{Vec3f(tilt.apply({0, 0, 0.5 + kParticleThickness}))}};
        const Vec3f begin = cloud.positions[0];
        for (int n = 0; n < 60; ++n) cloud.step(collision, {0, 0, -9.81F});
        const double pull = 9.81 * (std::sin(angle) - friction * std::cos(angle));
        const double expected = std::max(pull, 0.0) / 2; // after a second
        EXPECT_NEAR(length(cloud.positions[0] - begin), expected, 0.02 * expected + 1e-3) << friction;
        EXPECT_NEAR(length(cloud.velocities[0]), 2 * expected, 0.02 * expected + 1e-3) << friction;
    }
}

TEST(ParticleCollision, HasTheFrictionOfEachCollider) {
    const ExactMap box = ExactMap::build(make_box({4, 4, 1}));
    ParticleCollision collision({{.map = box}, {.map = box, .pose = {Rotation{}, {9, 0, 0}}}},
                                kParticleThickness);
    const auto slow_down = [&] {
        Cloud cloud{{{0, 0, 0.52F}, {9, 0, 0.52F}}};
        cloud.velocities = {{20, 0, -16}, {20, 0, -16}};
        cloud.step(collision);
        return std::array{cloud.velocities[0].x, cloud.velocities[1].x};
    };
    collision.set_collider_friction(1, 0);
    const auto first = slow_down();
    EXPECT_NEAR(first[0], 12, 1e-2);
    EXPECT_NEAR(first[1], 20, 1e-2);
    collision.set_collider_friction(1, 0.25);
    EXPECT_NEAR(slow_down()[1], 16, 1e-2);
}

TEST(ParticleCollision, GivesAVelocityThatIsNotThatOfThePositionsTheSameChange) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({4, 4, 1}))}}, kParticleThickness,
                                {.friction = 0});
    Cloud cloud{{{0, 0, 0.5F + float(kParticleThickness)}}};
    cloud.positions[0] = {0.01F, 0, 0.5F};
    cloud.velocities[0] = {7, 8, -0.2F};
    cloud.correct(collision);
    EXPECT_EQ(cloud.velocities[0].x, 7);
    EXPECT_EQ(cloud.velocities[0].y, 8);
    EXPECT_NEAR(cloud.velocities[0].z, -0.2 + kParticleThickness / kParticleSeconds, 1e-3);
}

TEST(ParticleCollision, PushesParticlesBeforeAModelThatComesAndTakesThemAlong) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    Cloud cloud{{{0, 0, 0.5F}}};
    for (int n = 1; n <= 10; ++n) {
        cloud.move();
        collision.set_collider_pose(0, {Rotation{}, {0, 0, 0.3 * n}}); // past the particle within two steps
        cloud.correct(collision);
        EXPECT_GT(cloud.positions[0].z, 0.3 * n + 0.05);
    }
    EXPECT_NEAR(cloud.velocities[0].z, 0.3 / kParticleSeconds, 1e-2);
}

TEST(ParticleCollision, CarriesWhatLiesOnATurntableAroundWithIt) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({4, 4, 0.2}))}}, kParticleThickness,
                                {.friction = 2});
    Cloud cloud{{{1, 0, 0.1F + float(kParticleThickness)}}};
    for (int n = 1; n <= 60; ++n) {
        cloud.move({0, 0, -9.81F});
        collision.set_collider_pose(0, {Rotation::about({0, 0, 1}, 0.01 * n), {}});
        cloud.correct(collision);
    }
    const float taken_by = 0.005F; // until friction had it at the table's speed
    EXPECT_NEAR(cloud.positions[0].x, std::cos(0.6F - taken_by), 2e-3);
    EXPECT_NEAR(cloud.positions[0].y, std::sin(0.6F - taken_by), 2e-3);
    EXPECT_NEAR(length(cloud.velocities[0]), 0.01 / kParticleSeconds, 1e-2);
    for (int n = 0; n < 60; ++n) cloud.step(collision, {0, 0, -9.81F}); // the table rests now
    EXPECT_NEAR(length(cloud.velocities[0]), 0, 1e-3);
}

TEST(ParticleCollision, SweepsNothingWhereAColliderIsPlacedElsewhere) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    Cloud cloud{{{0, 0, 0.5F}}};
    cloud.step(collision);
    collision.place_collider(0, {Rotation{}, {0, 0, 1}});
    cloud.step(collision);
    EXPECT_EQ(cloud.positions[0].z, 0.5F);
    EXPECT_EQ(collision.colliders()[0].pose.translation.z, 1);
}

TEST(ParticleCollision, LetsAParticleOutThatBeginsInside) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({1, 1, 1}))}}, kParticleThickness);
    Cloud cloud{{{0.1F, 0, 0.4F}}};
    cloud.step(collision);
    EXPECT_NEAR(cloud.positions[0].z, 0.5 + kParticleThickness, 1e-4);
    EXPECT_NEAR(length(cloud.velocities[0]), 0, 1e-3); // pushed, not thrown
    EXPECT_EQ(collision.lost_count(), 0u);
}

TEST(ParticleCollision, TakesAParticleThatItsSolverPutsElsewhereAsBeginningThere) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    Cloud cloud{{{0, 0, 0.5F}, {0.5F, 0, 0.5F}}};
    cloud.step(collision);
    cloud.positions[0].z = -0.5F; // to the other side: no motion
    cloud.velocities[1].z = -60;
    cloud.move();
    EXPECT_EQ(cloud.correct(collision), std::vector<std::uint32_t>{1});
    EXPECT_EQ(cloud.positions[0].z, -0.5F);
    cloud.velocities[0].z = 60; // and from there it is stopped
    cloud.step(collision);
    EXPECT_NEAR(cloud.positions[0].z, -0.05 - kParticleThickness, 1e-4);
}

TEST(ParticleCollision, BeginsAnewWithAnotherNumberOfParticles) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    for (const std::size_t count : {3u, 5u, 1u, 0u, 2u}) {
        Cloud cloud{std::vector<Vec3f>(count, Vec3f{0, 0, 0.5F})};
        for (Vec3f& velocity : cloud.velocities) velocity.z = -90;
        cloud.move();
        EXPECT_EQ(cloud.correct(collision).size(), count);
        for (const Vec3f& p : cloud.positions) EXPECT_NEAR(p.z, 0.05 + kParticleThickness, 1e-4);
    }
}

TEST(ParticleCollision, LeavesPinnedParticlesWhereTheSolverHasThemUntilTheyAreLetGo) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    Cloud cloud{{{0, 0, 0.5F}}};
    cloud.inverse_masses[0] = 0;
    cloud.velocities[0].z = -60;
    cloud.step(collision);
    EXPECT_EQ(cloud.positions[0].z, -0.5F);
    cloud.inverse_masses[0] = 1;
    cloud.velocities[0].z = 60;
    cloud.step(collision);
    EXPECT_NEAR(cloud.positions[0].z, -0.05 - kParticleThickness, 1e-4);
}

TEST(ParticleCollision, LeavesAParticleThatHasExplodedAsItIsAndTakesItBack) {
    for (const float bad : {kNan, std::numeric_limits<float>::infinity(), 1e20F, 3e38F, -1e20F}) {
        ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
        Cloud cloud{{{0, 0, 0.5F}, {0.5F, 0, 0.5F}, {0, 0.5F, 0.5F}}};
        cloud.step(collision);
        cloud.previous = cloud.positions;
        cloud.positions[0] = {0, bad, 0};
        cloud.velocities[0] = {bad, 0, 0};
        cloud.positions[1].z = -0.5F;
        EXPECT_EQ(cloud.correct(collision), std::vector<std::uint32_t>{1}); // no other suffers
        EXPECT_FALSE(std::fabs(cloud.positions[0].y) < 1e12F);
        EXPECT_FALSE(std::fabs(cloud.velocities[0].x) < 1e12F);
        cloud.previous = cloud.positions; // with the bad one
        cloud.positions[0] = {0, 0, 0.3F};
        EXPECT_TRUE(cloud.correct(collision).empty());
        cloud.velocities[0] = {0, 0, -60};
        cloud.step(collision);
        EXPECT_NEAR(cloud.positions[0].z, 0.05 + kParticleThickness, 1e-4);
        EXPECT_EQ(collision.lost_count(), 0u);
    }
}

TEST(ParticleCollision, LeavesAVelocityThatIsNotFiniteAndCorrectsThePosition) {
    ParticleCollision collision({{.map = ExactMap::build(make_box({2, 2, 0.1}))}}, kParticleThickness);
    Cloud cloud{{{0, 0, 0.5F}}};
    cloud.positions[0].z = -0.5F;
    cloud.velocities[0].z = kNan;
    cloud.correct(collision);
    EXPECT_NEAR(cloud.positions[0].z, 0.05 + kParticleThickness, 1e-4);
    EXPECT_TRUE(std::isnan(cloud.velocities[0].z));
}

TEST(ParticleCollision, GivesTheSameBitsForAnyNumberOfThreadsAndInCopies) {
    const ExactMap torus = ExactMap::build(make_torus(1, 0.4, 30, 12));
    const auto run = [&](unsigned thread_count, bool copies) {
        test::Random random(5);
        ParticleCollision collision({{.map = torus}, {.map = torus, .pose = {Rotation{}, {1, 0, 0}}}},
                                    kParticleThickness, {.thread_count = thread_count});
        Cloud cloud = cloud_in_cube(random, 5000, 2);
        for (int n = 0; n < 10; ++n) {
            for (Vec3f& velocity : cloud.velocities) velocity += test::in_cube(random, 10);
            cloud.move({0, 0, -9.81F});
            collision.set_collider_pose(1, random_pose(random, 0.2F));
            if (copies) collision = ParticleCollision(std::as_const(collision));
            cloud.correct(collision);
        }
        return std::pair(cloud.positions, cloud.velocities);
    };
    const auto alone = run(1, false);
    EXPECT_EQ(run(2, false), alone);
    EXPECT_EQ(run(3, false), alone);
    EXPECT_EQ(run(1, true), alone);
}

TEST(ParticleCollision, PushesOutOfDistanceMapsAndCustomMapsWithTheVelocityThatIsLeft) {
    const std::array<ColliderMap, 2> balls{DistanceMap::build(make_sphere(1, 80, 40)),
                                           std::make_shared<test::AnalyticBall>(1.0F)};
    for (const ColliderMap& ball : balls) {
        ParticleCollision collision({{.map = ball}}, kParticleThickness, {.friction = 0});
        Cloud cloud{{{0.02F, 0, 1.05F}}};
        cloud.velocities[0].z = -6;
        cloud.step(collision);
        EXPECT_NEAR(length(cloud.positions[0]), 1 + kParticleThickness, 3e-3);
        EXPECT_NEAR(cloud.velocities[0].z, 0, 0.2);
    }
}

TEST(ParticleCollision, RefusesWhatItCannotWorkWithAndChangesNothing) {
    const ExactMap box = ExactMap::build(make_box({1, 1, 1}));
    const auto refuse = [](const std::string& words, const auto& call) {
        test::expect_error(ErrorCode::InvalidOptions, words, call);
    };
    refuse("thickness", [&] { ParticleCollision({{.map = box}}, -1); });
    refuse("thickness", [&] { ParticleCollision({{.map = box}}, std::nan("")); });
    refuse("friction", [&] { ParticleCollision({{.map = box}}, 0.01, {.friction = -1}); });
    refuse("scale of 0", [&] { ParticleCollision({{.map = box, .scale = {}}}, 0.01); });
    ParticleCollision collision({{.map = box}}, kParticleThickness);
    refuse("friction", [&] { collision.set_collider_friction(0, -1); });
    refuse("too large for a float", [&] { collision.set_collider_pose(0, {{}, {-1e39, 0, 0}}); });
    refuse("length 2", [&] { collision.set_collider_pose(0, {Rotation{2, 0, 0, 0}, {}}); });
    refuse("not finite", [&] { collision.place_collider(0, {Rotation{}, {std::nan(""), 0, 0}}); });
    std::vector<Vec3f> previous(2, {0, 0, 2}), positions(2), velocities(2);
    std::vector<float> masses(2, 1);
    const auto refuse_step = [&](const std::string& words, const SolverStep& step, double seconds) {
        refuse(words, [&] { collision.correct(step, seconds); });
        EXPECT_EQ(positions, std::vector<Vec3f>(2));
    };
    for (const double seconds : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        refuse_step("seconds", {previous, positions, velocities, masses}, seconds);
    const auto one = [](auto& array) { return std::span(array).first(1); };
    refuse_step("1 previous positions", {one(previous), positions, velocities, masses}, kParticleSeconds);
    refuse_step("1 velocities", {previous, positions, one(velocities), masses}, kParticleSeconds);
    refuse_step("1 inverse masses", {previous, positions, velocities, one(masses)}, kParticleSeconds);
    for (const float bad : {-1.0F, kNan, std::numeric_limits<float>::infinity()}) {
        masses[1] = bad;
        refuse_step("particle 1 has an inverse mass", {previous, positions, velocities, masses},
                    kParticleSeconds);
    }
    EXPECT_EQ(collision.correct({previous, positions}, kParticleSeconds).size(), 2u);
}
