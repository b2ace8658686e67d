#include "support/draping.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

constexpr double kThickness = 0.01;

DistanceMap map_of(const TriangleMesh& mesh) {
    return DistanceMap::build(mesh, {.longitude_count = 128, .colatitude_count = 128});
}

/// Mean position of all particles.
Vec3d middle(const Simulation& simulation) {
    Vec3d sum;
    for (const Vec3f& p : simulation.positions()) sum += Vec3d(p);
    return sum * (1.0 / double(simulation.positions().size()));
}

} // namespace

TEST(Draping, LaysASheetFlatOnABoxAtItsThickness) {
    // The map of a flat side is exact to the sagitta between samples: 0.001 here.
    Simulation simulation(test::sheet_at(0.55, 0.5, 15), {{.map = map_of(make_box({1, 1, 1}))}},
                          {.thickness = kThickness});
    test::run_to_rest(simulation, 1000);
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(p.z, 0.5 + kThickness, 2e-3);
    EXPECT_NEAR(middle(simulation).x, 0, 1e-3);
    EXPECT_NEAR(middle(simulation).y, 0, 1e-3);
}

TEST(Draping, BringsASheetOnASphereToRestOutside) {
    Simulation simulation(test::sheet_at(1.05, 2, 21), {{.map = map_of(make_sphere(1, 80, 40))}},
                          {.thickness = kThickness, .friction = 0.8});
    test::run_to_rest(simulation, 6000);
    test::expect_draped_over_unit_ball(simulation, kThickness);
}

TEST(Draping, HoldsASheetOnASlopeThatFrictionCanHoldAndNotOnASteeperOne) {
    // Coulomb: it rests where the slope's tangent is below the friction.
    const DistanceMap box = map_of(make_box({2, 2, 1}));
    EXPECT_LT(test::slid_down_slope(box, std::atan(0.4)), 0.005);
    EXPECT_GT(test::slid_down_slope(box, std::atan(0.6)), 0.05);
}

TEST(Draping, CarriesASheetAlongWithAMovingCollider) {
    const Collider box{.map = map_of(make_box({2, 2, 1})), .linear_velocity = {0.3, 0, 0}};
    Simulation simulation(test::sheet_at(0.5 + kThickness, 0.3, 7), {box},
                          {.thickness = kThickness, .friction = 0.8});
    for (int i = 0; i < 480; ++i) simulation.step();
    EXPECT_NEAR(simulation.colliders()[0].pose.translation.x, 0.6, 1e-9);
    EXPECT_NEAR(middle(simulation).x, 0.6, 0.03);
    EXPECT_NEAR(middle(simulation).y, 0, 1e-3);
}

TEST(Draping, TurnsASheetWithATurningColliderAndDoesNotFlingItOff) {
    const Collider box{.map = map_of(make_box({2, 2, 1})), .angular_velocity = {0, 0, 1}};
    Simulation simulation(test::sheet_at(0.5 + kThickness, 0.3, 7), {box},
                          {.thickness = kThickness, .friction = 0.8});
    const Vec3f corner = simulation.positions()[0];
    for (int i = 0; i < 240; ++i) simulation.step();
    const Vec3d expected = Rotation::about({0, 0, 1}, 1).apply(Vec3d(corner));
    EXPECT_NEAR(length(Vec3d(simulation.positions()[0]) - expected), 0, 0.02);
}

TEST(Draping, LiftsASheetOnARisingCollider) {
    const Collider box{.map = map_of(make_box({2, 2, 1})), .linear_velocity = {0, 0, 0.5}};
    Simulation simulation(test::sheet_at(0.5 + kThickness, 0.3, 7), {box}, {.thickness = kThickness});
    for (int i = 0; i < 240; ++i) simulation.step();
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(p.z, 1 + kThickness, 3e-3);
}

TEST(Draping, LetsAParticleOutThatBeganInside) {
    Deformable particle{.positions = {{0.1F, 0.05F, 0.8F}},
                        .previous_positions = {{0.1F, 0.05F, 0.8F}},
                        .inverse_masses = {1},
                        .sticks = {},
                        .faces = {}};
    Simulation simulation(particle, {{.map = map_of(make_sphere(1, 80, 40))}}, {.thickness = kThickness});
    for (int i = 0; i < 60; ++i) simulation.step();
    EXPECT_GT(length(simulation.positions()[0]), 0.999);
}

TEST(Draping, LeavesPinnedParticlesAloneEvenInside) {
    Deformable particle{.positions = {{0, 0, 0.5F}},
                        .previous_positions = {{0, 0, 0.5F}},
                        .inverse_masses = {0},
                        .sticks = {},
                        .faces = {}};
    Simulation simulation(particle, {{.map = map_of(make_sphere(1, 80, 40))}}, {.thickness = kThickness});
    simulation.step();
    EXPECT_EQ(simulation.positions()[0], (Vec3f{0, 0, 0.5F}));
}

TEST(Draping, AsksEveryColliderAboutEveryParticleInEveryRelaxation) {
    const Collider box{.map = map_of(make_box({1, 1, 1}))};
    Simulation simulation(test::sheet_at(2, 0.5, 4), {box, box}, {.iteration_count = 7});
    simulation.step();
    EXPECT_EQ(simulation.profile().query_count, 16u * 2u * 7u);
    EXPECT_EQ(simulation.profile().contact_count, 0u);
}

TEST(Draping, GivesTheSameBitsOnEveryRunAmongMovingColliders) {
    const auto hash = [] {
        const Collider torus{.map = map_of(make_torus(1, 0.4, 30, 16)), .angular_velocity = {0.2, 0.1, 0.5}};
        Simulation simulation(test::sheet_at(0.45, 2, 20), {torus}, {.thickness = kThickness});
        for (int i = 0; i < 100; ++i) simulation.step();
        EXPECT_GT(simulation.profile().contact_count, 0u);
        return simulation.state_hash();
    };
    EXPECT_EQ(hash(), hash());
}
