#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

const SimulationOptions kWeightless{.time_step = 0.01, .gravity = {}, .drag = 0};

/// A sheet in the plane z = 0 around the origin.
Simulation sheet(const SimulationOptions& options, std::vector<std::uint32_t> pins = {}) {
    return Simulation(make_cloth({.column_count = 6, .row_count = 6, .pins = std::move(pins)}), {}, options);
}

Vec3d mean_velocity(const Simulation& simulation) {
    const Deformable& d = simulation.deformable();
    Vec3d sum;
    for (std::size_t i = 0; i < d.particle_count(); ++i)
        sum += Vec3d(d.positions[i]) - Vec3d(d.previous_positions[i]);
    return sum * (1 / (simulation.options().time_step * static_cast<double>(d.particle_count())));
}

} // namespace

TEST(Steering, GivesAParticleItsVelocity) {
    Simulation simulation({.positions = {{1, 2, 3}},
                           .previous_positions = {{1, 2, 3}},
                           .inverse_masses = {1},
                           .sticks = {},
                           .faces = {}},
                          {}, kWeightless);
    simulation.set_particle_velocity(0, {10, 0, -20});
    simulation.step();
    EXPECT_NEAR(simulation.positions()[0].x, 1.1, 1e-6);
    EXPECT_NEAR(simulation.positions()[0].z, 2.8, 1e-6);
    EXPECT_NEAR(simulation.largest_speed(), std::sqrt(500), 1e-3);
}

TEST(Steering, LeavesAPinnedParticleWhereItIs) {
    Simulation simulation = sheet(kWeightless, {0});
    const Vec3f before = simulation.positions()[0];
    simulation.set_particle_velocity(0, {10, 0, 0});
    for (int i = 0; i < 10; ++i) {
        simulation.blow({0, 0, 10}, 5);
        simulation.step();
    }
    EXPECT_EQ(simulation.positions()[0], before);
    EXPECT_GT(simulation.positions()[35].z, 0);
}

TEST(Steering, DragsNoParticleIntoAModel) {
    const TriangleMesh torus = make_torus(1, 0.4, 24, 12);
    const Collider collider{.map = ExactMap::build(torus)};
    const ClothOptions cloth{.column_count = 20,
                             .row_count = 20,
                             .width = 3,
                             .height = 3,
                             .pose = {.rotation = {}, .translation = {0, 0, 0.5}}};
    Simulation simulation(make_cloth(cloth), {collider}, {});
    for (int i = 0; i < 100; ++i) {
        const std::size_t grabbed = 190;
        // Through the ring's tube to the other side.
        const Vec3d way = Vec3d{1, 0, -2} - Vec3d(simulation.positions()[grabbed]);
        simulation.set_particle_velocity(grabbed, way * (0.2 / simulation.options().time_step));
        simulation.step();
    }
    for (const Vec3f& position : simulation.positions()) EXPECT_FALSE(contains(collider, position));
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST(Steering, WindAcrossASheetCarriesItAlongInTheEnd) {
    Simulation simulation = sheet(kWeightless);
    for (int i = 0; i < 300; ++i) {
        simulation.blow({0, 0, 2}, 5);
        simulation.step();
    }
    EXPECT_NEAR(mean_velocity(simulation).z, 2, 0.01);
}

TEST(Steering, WindGivesItsShareInOneFrame) {
    Simulation simulation = sheet(kWeightless);
    simulation.blow({3, -1, 2}, 5);
    // Along the sheet, air slips by.
    const Vec3d velocity = mean_velocity(simulation);
    EXPECT_NEAR(velocity.x, 0, 1e-5);
    EXPECT_NEAR(velocity.y, 0, 1e-5);
    EXPECT_NEAR(velocity.z, 5 * 0.01 * 2, 1e-5);
}

TEST(Steering, AirAtRestBrakesAndNeverTurnsRound) {
    Simulation simulation = sheet(kWeightless);
    for (std::size_t i = 0; i < simulation.positions().size(); ++i)
        simulation.set_particle_velocity(i, {0, 0, 1});
    simulation.blow({}, 1e9);
    EXPECT_NEAR(mean_velocity(simulation).z, 0, 1e-5);
}
