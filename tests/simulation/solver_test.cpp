#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace echinus;

namespace {

Deformable single_particle(const Vec3f& position, const Vec3f& velocity) {
    return {.positions = {position},
            .velocities = {velocity},
            .inverse_masses = {1},
            .constraints = {},
            .faces = {}};
}

/// A sheet whose particles differ in mass and start with a velocity that stretches and turns it.
Deformable lively_cloth() {
    Deformable cloth = make_cloth({.column_count = 8, .row_count = 6});
    cloth.velocities.resize(cloth.particle_count());
    for (std::size_t i = 0; i < cloth.particle_count(); ++i) {
        cloth.inverse_masses[i] = 1.0F / static_cast<float>(1 + i % 3);
        const Vec3f& p = cloth.positions[i];
        cloth.velocities[i] = Vec3f{-p.y + p.x, p.x, 0.3F * p.x * p.y + 0.1F};
    }
    return cloth;
}

double largest_strain(const Simulation& simulation, ConstraintKind kind) {
    double largest = 0;
    for (const DistanceConstraint& constraint : simulation.deformable().constraints) {
        if (constraint.kind != kind) continue;
        const double distance =
            length(simulation.positions()[constraint.b] - simulation.positions()[constraint.a]);
        largest = std::max(largest, std::abs(distance / constraint.rest_length - 1));
    }
    return largest;
}

} // namespace

TEST(Solver, LosesNothingOfGravityWhereverAParticleHasComeTo) {
    // Gravity moves a particle in a frame by little more than the last digit of a coordinate of 2000.
    const SimulationOptions options{
        .solver = NewtonOptions{.air_drag = 0}, .gravity = {-9.81, 0, 0}, .bound = 1e5};
    Simulation simulation(single_particle({}, {}), {}, options);
    simulation.set_particle_velocity(0, {1000, 0, 0});
    for (int i = 0; i < 120; ++i) simulation.step();
    const float before = simulation.positions()[0].x;
    for (int i = 0; i < 60; ++i) simulation.step();
    EXPECT_NEAR(double{simulation.positions()[0].x - before}, 1000 - 9.81 * 2.5, 0.1);
}

TEST(Solver, TellsTheShapeAtRestOfWhatItHasStretched) {
    ClothOptions sheet{.column_count = 3, .row_count = 9, .width = 0.2, .pins = {24, 25, 26}};
    sheet.pose.rotation = Rotation::about({1, 0, 0}, std::acos(0.0));
    const Deformable cloth = make_cloth(sheet);
    SimulationOptions options;
    options.newton().material.stretch_stiffness = 10; // so that it hangs by a tenth longer
    Simulation first(cloth, {}, options);
    for (int i = 0; i < 240; ++i) first.step();
    EXPECT_EQ(first.deformable().rest_positions, cloth.positions);
    EXPECT_LT(first.positions()[1].z, cloth.positions[1].z - 0.05F);
    // Another simulation of it goes on with the same material, which is stretched already.
    Simulation second(first.deformable(), {}, options);
    for (int i = 0; i < 240; ++i) second.step();
    EXPECT_NEAR(second.positions()[1].z, first.positions()[1].z, 0.01);
}

TEST(Solver, TakesTheDragFromTheVelocityInEveryFrame) {
    const SimulationOptions options =
        test::jakobsen({.solver = JakobsenOptions{.drag = 0.1}, .time_step = 0.01, .gravity = {}});
    Simulation simulation(single_particle({}, {100, 0, 0}), {}, options);
    simulation.step();
    EXPECT_NEAR(simulation.positions()[0].x, 0.9, 1e-6);
    simulation.step();
    EXPECT_NEAR(simulation.positions()[0].x, 0.9 + 0.81, 1e-6);
    EXPECT_NEAR(simulation.largest_speed(), 81, 1e-3);
}

TEST(Solver, BringsConstraintsBackToTheirLength) {
    Deformable cloth = make_cloth({.column_count = 10, .row_count = 10});
    for (Vec3f& p : cloth.positions) p *= 1.3F;
    Simulation simulation(cloth, {},
                          test::jakobsen({.solver = JakobsenOptions{.drag = 0.05}, .gravity = {}}));
    EXPECT_NEAR(largest_strain(simulation, ConstraintKind::Structural), 0.3, 1e-3);
    for (int i = 0; i < 300; ++i) simulation.step();
    for (const ConstraintKind kind :
         {ConstraintKind::Structural, ConstraintKind::Shear, ConstraintKind::Bending})
        EXPECT_LT(largest_strain(simulation, kind), 1e-3);
}

TEST(Solver, HangsAChainFromItsPinWithNoMoreStretchThanItsWeightMakes) {
    Deformable chain;
    for (int i = 0; i < 5; ++i) chain.positions.push_back({float(i) * 0.1F, 0, 0});
    chain.inverse_masses = {0, 1, 1, 1, 1};
    for (std::uint32_t i = 0; i < 4; ++i)
        chain.constraints.push_back({i, i + 1, 0.1F, ConstraintKind::Structural});
    Simulation simulation(chain, {}, test::jakobsen({.solver = JakobsenOptions{.drag = 0.02}}));
    for (int i = 0; i < 3000 && !simulation.at_rest(); ++i) simulation.step();
    EXPECT_TRUE(simulation.at_rest());
    EXPECT_EQ(simulation.positions()[0], Vec3f{});
    EXPECT_NEAR(simulation.positions()[4].z, -0.4, 0.01);
    EXPECT_NEAR(simulation.positions()[4].x, 0, 0.01);
}

TEST(Solver, LeavesTwoParticlesOnOneSpotFinite) {
    Deformable pair{.positions = {{1, 1, 1}, {1, 1, 1}},
                    .inverse_masses = {1, 1},
                    .constraints = {{0, 1, 1, ConstraintKind::Structural}},
                    .faces = {}};
    Simulation simulation(pair, {}, test::jakobsen({.gravity = {}}));
    simulation.step();
    EXPECT_EQ(simulation.positions()[0], (Vec3f{1, 1, 1}));
}

TEST(Solver, GivesTheSameBitsOnEveryRunAndInEveryCopy) {
    Simulation first(lively_cloth(), {}, test::jakobsen());
    Simulation second(lively_cloth(), {}, test::jakobsen());
    for (int i = 0; i < 20; ++i) first.step();
    for (int i = 0; i < 10; ++i) second.step();
    EXPECT_NE(first.state_hash(), second.state_hash());
    Simulation copy = second;
    for (int i = 0; i < 10; ++i) second.step();
    for (int i = 0; i < 10; ++i) copy.step();
    EXPECT_EQ(first.state_hash(), second.state_hash());
    EXPECT_EQ(first.state_hash(), copy.state_hash());
}

TEST(Solver, SeparatesStatesThatDifferOnlyInVelocity) {
    const Simulation slow(single_particle({1, 2, 3}, {}), {}, {});
    const Simulation fast(single_particle({1, 2, 3}, {0, 0, 0.5F}), {}, {});
    EXPECT_NE(slow.state_hash(), fast.state_hash());
}

TEST(Solver, RestsWhenItHasStayedNearOnePlaceForSoManyFrames) {
    const RestCondition rest{.distance = 0.0013, .speed = 1, .frame_count = 5};
    Simulation simulation(
        single_particle({}, {1, 0, 0}), {},
        test::jakobsen(
            {.solver = JakobsenOptions{.drag = 0.5}, .time_step = 0.01, .gravity = {}, .rest = rest}));
    // It goes by 5, 2.5, 1.25, 0.6 ... mm. The third step alone is short enough but leads too far with the
    // fourth; all later ones together are shorter: at rest with the ninth.
    for (int i = 0; i < 8; ++i) simulation.step();
    EXPECT_FALSE(simulation.at_rest());
    simulation.step();
    EXPECT_TRUE(simulation.at_rest());
}

TEST(Solver, DoesNotRestWhileAParticleTremblesInItsPlace) {
    Simulation simulation(single_particle({}, {}), {},
                          {.time_step = 1.0 / 240, .gravity = {}, .rest = {.frame_count = 20}});
    // To and fro by 0.8 mm, at 0.2 units per second.
    for (int i = 0; i < 100; ++i) {
        simulation.set_particle_velocity(0, {i % 2 == 0 ? 0.2 : -0.2, 0, 0});
        simulation.step();
        ASSERT_FALSE(simulation.at_rest()) << "frame " << i;
    }
    simulation.set_particle_velocity(0, {});
    for (int i = 0; i < 21; ++i) simulation.step();
    EXPECT_TRUE(simulation.at_rest());
}

TEST(Solver, NamesTheFrameInWhichItDiverges) {
    Simulation simulation(
        single_particle({}, {240, 0, 0}), {},
        test::jakobsen({.solver = JakobsenOptions{.drag = 0}, .gravity = {}, .bound = 10.5}));
    test::expect_error(ErrorCode::Diverged, "frame 11", [&] {
        for (int i = 0; i < 20; ++i) simulation.step();
    });
}

TEST(Solver, TakesOverflowForDivergence) {
    Simulation simulation(single_particle({}, {1e38F, 0, 0}), {}, {.gravity = {}, .bound = 1e30});
    EXPECT_THROW(simulation.step(), Error);
}

TEST(Solver, VelocitiesBeyondAllBoundsDivergeInEachFurtherStepToo) {
    const auto expect_divergence = [&](const char* of, const auto& disturb) {
        for (const bool surfaces : {false, true}) {
            Simulation simulation(
                test::sheet_at(0.2, 0.5, 9), test::colliders_of({make_sphere(0.15, 24, 12)}),
                surfaces ? SimulationOptions{.solver = NewtonOptions{.collision = CollisionMode::Surfaces},
                                             .thickness = 0.01}
                         : test::jakobsen({.thickness = 0.01}));
            simulation.step();
            disturb(simulation);
            for (int i = 0; i < 3; ++i)
                test::expect_error(ErrorCode::Diverged, of, [&] { simulation.step(); });
            EXPECT_EQ(simulation.frame(), 1);
        }
    };
    for (const double large : {1e50, 1e300, -1e300}) {
        expect_divergence("in frame 2: particle 0", [&](Simulation& s) {
            s.set_particle_velocity(0, {large, 0, 0});
        });
        expect_divergence("in frame 2: collider 0", [&](Simulation& s) {
            s.set_collider_velocity(0, {large, 0, 0}, {});
        });
        expect_divergence("in frame 2: collider 0", [&](Simulation& s) {
            s.set_collider_velocity(0, {}, {0, 0, large});
        });
        expect_divergence("in frame 2: particle 0", [&](Simulation& s) { s.blow({0, 0, large}, 1e9); });
    }
}

TEST(Solver, TellsHowFarStructuralConstraintsAreFromTheirLength) {
    Deformable cloth = make_cloth({.column_count = 3, .row_count = 2, .width = 2, .height = 1});
    cloth.inverse_masses.assign(6, 0);
    for (Vec3f& p : cloth.positions) p.x *= 1.5F; // four constraints of seven are longer by a half
    const Residual residual = Simulation(cloth, {}, {}).residual();
    EXPECT_NEAR(residual.largest, 0.5, 1e-6);
    EXPECT_NEAR(residual.root_mean_square, std::sqrt(4 * 0.25 / 7), 1e-6);
    EXPECT_EQ(Simulation(single_particle({}, {}), {}, {}).residual().largest, 0);
}
