// Particles beside exact maps. Whether a particle is lost is judged from outside: by contains() and sweep()
// of the collider, from where the particle was at the end of one frame to where it is at the end of the next.

#include "support/draping.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

namespace {

constexpr double kContactThickness = 0.01;

Deformable particles_at(const std::vector<Vec3f>& places) {
    return {.positions = places,
            .velocities = std::vector<Vec3f>(places.size()),
            .inverse_masses = std::vector<float>(places.size(), 1),
            .constraints = {},
            .faces = {}};
}

/// Steps, and counts the particles that are lost in this frame.
std::size_t step_and_count_lost(Simulation& simulation) {
    const std::vector<Vec3f> before(simulation.positions().begin(), simulation.positions().end());
    const std::vector<Collider> colliders_before = simulation.colliders();
    simulation.step();
    std::size_t lost = 0;
    for (std::size_t c = 0; c < colliders_before.size(); ++c) {
        const Collider& now = simulation.colliders()[c];
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (contains(colliders_before[c], before[i])) continue; // began inside
            const Vec3f& place = simulation.positions()[i];
            const bool crossed = sweep(now, colliders_before[c].pose, before[i], place).found();
            lost += crossed || contains(now, place) ? 1 : 0;
        }
    }
    return lost;
}

std::size_t lost_in(Simulation& simulation, int frame_count) {
    std::size_t lost = 0;
    for (int i = 0; i < frame_count; ++i) lost += step_and_count_lost(simulation);
    return lost;
}

/// A plate that comes up and turns over, and a sheet shot down at it.
///
///        _____________  sheet, 30 down
///
///      ------------- plate, 0.001 thick, 5 up and three turns a second
Simulation plate_and_sheet(bool keep_free) {
    constexpr double kStep = 1.0 / 240;
    const Collider plate{.map = ExactMap::build(make_box({1.5, 1.5, 0.001})),
                         .linear_velocity = {0.5, 0, 5},
                         .angular_velocity = {4, 18, 2}};
    return Simulation(test::sheet_at(0.7, 1, 25, {0, 0, -30}), {plate},
                      test::jakobsen({.solver = JakobsenOptions{.keep_free = keep_free},
                                      .time_step = kStep,
                                      .thickness = kContactThickness}));
}

} // namespace

TEST(ThinPlate, ThatMovesAndTurnsFastLosesNoParticleOfAFastSheet) {
    Simulation simulation = plate_and_sheet(true);
    EXPECT_EQ(lost_in(simulation, 240), 0u);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
    EXPECT_GT(simulation.profile().rescued_count, 0u);
}

TEST(ThinPlate, WouldLoseParticlesWithoutTheSweepAfterTheConstraints) {
    Simulation simulation = plate_and_sheet(false);
    const std::size_t lost = lost_in(simulation, 240);
    EXPECT_GT(lost, 100u);
    EXPECT_EQ(simulation.profile().lost_count, lost);
    EXPECT_EQ(simulation.profile().rescued_count, 0u);
}

TEST(ExactCollision, LosesNoParticleHoweverFastAmongModelsOfAnyScale) {
    test::Random random(21);
    const ExactMap torus = ExactMap::build(make_torus(1, 0.4, 30, 12));
    const ExactMap plate = ExactMap::build(make_box({2, 2, 0.001}));
    for (int n = 0; n < 12; ++n) {
        const Collider collider{.map = n % 2 == 0 ? torus : plate,
                                .pose = {Rotation::about({1, 2, 3}, n), {1, 2, 3}},
                                .scale = n % 3 == 0 ? Vec3d{1, 1, 1} : Vec3d{0.5, -1.5, 1},
                                .linear_velocity = Vec3d(test::in_cube(random, 3)),
                                .angular_velocity = Vec3d(test::in_cube(random, 20))};
        std::vector<Vec3f> places;
        for (int i = 0; i < 200; ++i) places.push_back(test::in_cube(random, 1.5F) + Vec3f{1, 2, 3});
        Deformable particles = particles_at(places);
        for (Vec3f& velocity : particles.velocities) velocity = test::in_cube(random, 240);
        for (std::uint32_t i = 0; i + 1 < 200; ++i)
            particles.constraints.push_back({i, i + 1, 0.5F, ConstraintKind::Structural});
        Simulation simulation(particles, {collider},
                              test::jakobsen({.thickness = n % 4 == 0 ? 0 : kContactThickness}));
        EXPECT_EQ(lost_in(simulation, 60), 0u);
        EXPECT_EQ(simulation.profile().lost_count, 0u);
    }
}

TEST(ExactCollision, FarFromTheOriginLosesNoParticleToTheRoundingOfItsPosition) {
    // At 1000 units a float resolves 6e-5, thirty steps of the lattice.
    test::Random random(22);
    const Vec3f far{1000, -700, 500};
    const Collider torus{.map = ExactMap::build(make_torus(1, 0.4, 30, 12)),
                         .pose = {Rotation{}, Vec3d(far)},
                         .angular_velocity = {1, 5, 2}};
    std::vector<Vec3f> places;
    for (int i = 0; i < 300; ++i) places.push_back(far + test::in_cube(random, 1.5F));
    Deformable particles = particles_at(places);
    for (Vec3f& velocity : particles.velocities) velocity = test::in_cube(random, 24);
    Simulation simulation(particles, {torus}, test::jakobsen({.gravity = {}}));
    EXPECT_EQ(lost_in(simulation, 100), 0u);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(ExactCollision, DoesNotAddToTheSpeedOfAParticle) {
    test::Random random(23);
    const Collider torus{.map = ExactMap::build(make_torus(1, 0.4, 30, 12))};
    std::vector<Vec3f> places;
    std::vector<Vec3f> steps;
    constexpr float kRate = 240; // frames per second
    for (int i = 0; i < 500; ++i) {
        places.push_back(test::unit_vector(random) * 2);
        steps.push_back((test::in_cube(random, 1) - places.back()) * test::uniform(random, 0.001F, 0.5F));
    }
    Deformable particles = particles_at(places);
    for (std::size_t i = 0; i < places.size(); ++i) particles.velocities[i] = steps[i] * kRate;
    Simulation simulation(
        particles, {torus},
        test::jakobsen(
            {.solver = JakobsenOptions{.drag = 0}, .gravity = {}, .thickness = kContactThickness}));
    for (int frame = 0; frame < 100; ++frame) {
        simulation.step();
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Deformable& d = simulation.deformable();
            const Vec3f step = d.velocities[i] * (1 / kRate);
            ASSERT_LE(length(step), length(steps[i]) + 1e-5F);
            steps[i] = step;
        }
    }
    EXPECT_GT(simulation.profile().contact_count, 100u);
}

TEST(ExactCollision, LetsAParticleOutThatBeganInsideAndKeepsItOutsideFromThenOn) {
    const Collider sphere{.map = ExactMap::build(make_sphere(1, 80, 40))};
    Simulation simulation(particles_at({{0.1F, 0.05F, 0.8F}, {0, 0, 0}}), {sphere},
                          test::jakobsen({.gravity = {}, .thickness = kContactThickness}));
    simulation.step();
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(length(p), 1 + kContactThickness, 5e-3);
    for (int i = 0; i < 60; ++i) EXPECT_EQ(step_and_count_lost(simulation), 0u);
    // Pushed, not thrown.
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(length(p), 1 + kContactThickness, 5e-3);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(ExactCollision, KeepsAParticleFreeOfTwoCollidersWhileThereIsRoom) {
    // Two plates that close on a sheet and stop 0.004 apart: nearer than its thickness, but room enough.
    const ExactMap plate = ExactMap::build(make_box({1, 1, 0.1}));
    const Collider below{.map = plate, .pose = {Rotation{}, {0, 0, -0.052}}};
    const Collider above{.map = plate, .pose = {Rotation{}, {0, 0, 0.152}}, .linear_velocity = {0, 0, -1}};
    Simulation simulation(test::sheet_at(0.02, 0.5, 8), {below, above},
                          test::jakobsen({.thickness = kContactThickness}));
    EXPECT_EQ(lost_in(simulation, 24), 0u);
    simulation.set_collider_velocity(1, {}, {});
    EXPECT_EQ(lost_in(simulation, 60), 0u);
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(ExactCollision, CountsTheParticlesThatGetInsideAnOpenMesh) {
    TriangleMesh open = make_box({1, 1, 1}, 4);
    std::erase_if(open.faces, [&](const Triangle& face) {
        return std::ranges::all_of(face, [&](std::uint32_t v) { return open.vertices[v].z > 0.49F; });
    });
    Simulation simulation(test::sheet_at(0.6, 0.8, 9), {{.map = ExactMap::build(open)}},
                          test::jakobsen({.thickness = kContactThickness, .allow_open_colliders = true}));
    for (int i = 0; i < 60; ++i) simulation.step();
    const auto inside_count = std::ranges::count_if(
        simulation.positions(), [&](const Vec3f& p) { return contains(simulation.colliders()[0], p); });
    EXPECT_GT(inside_count, 0);
    EXPECT_GE(simulation.profile().lost_count, static_cast<std::uint64_t>(inside_count));
}

TEST(ExactCollision, CountsWhatTwoCollidersThatOverlapLeaveNoRoomFor) {
    const ExactMap plate = ExactMap::build(make_box({1, 1, 0.5}));
    const Collider below{.map = plate, .pose = {Rotation{}, {0, 0, -0.26}}};
    const Collider above{.map = plate, .pose = {Rotation{}, {0, 0, 0.26}}, .linear_velocity = {0, 0, -0.5}};
    Simulation simulation(particles_at({{0, 0, 0}}), {below, above},
                          test::jakobsen({.thickness = kContactThickness}));
    for (int i = 0; i < 48; ++i) simulation.step();
    EXPECT_GT(simulation.profile().lost_count, 0u);
    EXPECT_FALSE(contains(simulation.colliders()[0], simulation.positions()[0]));
}

TEST(ExactCollision, AnswersParticlesThatHardlyMoveFromMemory) {
    Simulation simulation(test::sheet_at(0.5 + kContactThickness, 0.5, 10),
                          {{.map = ExactMap::build(make_box({1, 1, 1}))}},
                          test::jakobsen({.thickness = kContactThickness}));
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_EQ(simulation.profile().query_count, 100u * 100u * 10u);
    EXPECT_LT(simulation.profile().map_query_count, simulation.profile().query_count / 20);
}
