// The paper's simulation, SolverKind::Jakobsen.

#include "support/draping.hpp"
#include "support/expectations.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

using namespace echinus;
using namespace echinus::test;

namespace {

Vec3d whole_momentum(const Simulation& simulation) {
    const Deformable& d = simulation.deformable();
    Vec3d sum;
    for (std::size_t i = 0; i < d.particle_count(); ++i)
        sum += Vec3d(d.velocities[i]) * (1.0 / d.inverse_masses[i]);
    return sum;
}

/// Its particles differ in mass, and start with a velocity that stretches and turns it.
Deformable lively_sheet() {
    Deformable sheet = sheet_at(0, 1, 8);
    for (std::size_t i = 0; i < sheet.particle_count(); ++i) {
        sheet.inverse_masses[i] = 1.0F / static_cast<float>(1 + i % 3);
        const Vec3f p = sheet.positions[i];
        sheet.velocities.push_back(Vec3f{p.x - p.y, p.x, 0.3F * p.x * p.y + 0.1F} * 2.4F);
    }
    return sheet;
}

} // namespace

TEST(Jakobsen, LetsAParticleFallAsVerletDoes) {
    // Without drag, n steps from rest fall by g dt^2 n (n + 1) / 2.
    Deformable particle{.positions = {{}}, .inverse_masses = {1}, .constraints = {}, .faces = {}};
    Simulation simulation(
        particle, {},
        jakobsen({.solver = JakobsenOptions{.drag = 0}, .time_step = 0.01, .gravity = {0, 0, -10}}));
    for (int i = 0; i < 100; ++i) simulation.step();
    EXPECT_NEAR(simulation.positions()[0].z, -10 * 0.01 * 0.01 * 100 * 101 / 2, 1e-4);
}

TEST(Jakobsen, KeepsTheMomentumOfAFreeSheet) {
    Simulation simulation(lively_sheet(), {},
                          jakobsen({.solver = JakobsenOptions{.drag = 0}, .gravity = {}}));
    const Vec3d before = whole_momentum(simulation);
    ASSERT_GT(length(before), 0.01);
    for (int i = 0; i < 200; ++i) simulation.step();
    EXPECT_NEAR(length(whole_momentum(simulation) - before), 0, 1e-3 * length(before));
}

TEST(Jakobsen, RemovesTheShareOfAnErrorThatTheStiffnessOfItsKindSaysByTheMasses) {
    for (const ConstraintKind kind :
         {ConstraintKind::Structural, ConstraintKind::Shear, ConstraintKind::Bending}) {
        Deformable pair{.positions = {{0, 0, 0}, {2, 0, 0}},
                        .inverse_masses = {1, 3},
                        .constraints = {{0, 1, 1, kind}},
                        .faces = {}};
        SimulationOptions options =
            jakobsen({.solver = JakobsenOptions{.iteration_count = 1}, .gravity = {}});
        options.jakobsen().stiffness[static_cast<std::size_t>(kind)] = 0.6;
        Simulation simulation(pair, {}, options);
        simulation.step();
        EXPECT_NEAR(simulation.positions()[0].x, 0.6 * 0.25, 1e-6);
        EXPECT_NEAR(simulation.positions()[1].x, 2 - 0.6 * 0.75, 1e-6);
    }
}

TEST(Jakobsen, HangsASheetByItsCornersBelowThem) {
    Deformable sheet = sheet_at(0, 1, 11);
    for (const std::uint32_t corner : {0u, 10u}) sheet.inverse_masses[corner] = 0;
    Simulation simulation(sheet, {},
                          jakobsen({.solver = JakobsenOptions{.iteration_count = 40, .drag = 0.05}}));
    run_to_rest(simulation, 3000);
    for (const std::uint32_t corner : {0u, 10u})
        EXPECT_EQ(simulation.positions()[corner], sheet.positions[corner]);
    const auto [low, high] = std::minmax_element(simulation.positions().begin(), simulation.positions().end(),
                                                 [](const Vec3f& a, const Vec3f& b) { return a.z < b.z; });
    EXPECT_EQ(high->z, 0);
    EXPECT_NEAR(low->z, -1, 0.15); // with a sag along its upper edge
    EXPECT_LT(simulation.residual().root_mean_square, 0.03);
}

TEST(Jakobsen, LosesNoParticleToAnExactMapHoweverFast) {
    // A plate that turns, a hundredth as thick as the way of a particle in a frame.
    const Collider plate{.map = ExactMap::build(make_box({2, 2, 0.002})),
                         .linear_velocity = {0, 0, 20},
                         .angular_velocity = {1, 0, 2}};
    for (const bool keep_free : {true, false}) {
        Simulation simulation(
            sheet_at(0.5, 1, 21, {0, 0, -48}), {plate},
            jakobsen({.solver = JakobsenOptions{.keep_free = keep_free}, .thickness = 0.01}));
        for (int i = 0; i < 60; ++i) simulation.step();
        EXPECT_EQ(simulation.profile().lost_count == 0, keep_free);
    }
}

TEST(Jakobsen, LaysASheetOnABallWithADistanceMapOutsideOfIt) {
    const Collider ball{.map = DistanceMap::build(make_sphere(1, 80, 40))};
    Simulation simulation(sheet_at(1.05, 2, 15), {ball}, jakobsen({.thickness = 0.01, .friction = 0.8}));
    run_to_rest(simulation, 6000);
    expect_draped_over_unit_ball(simulation, 0.01);
}

TEST(Jakobsen, RefusesWhatItDoesNotHaveAndNamesTheNewtonSolver) {
    const auto expect_refusal = [](const char* cause, const Deformable& deformable,
                                   SimulationOptions options = {}) {
        expect_error(ErrorCode::InvalidOptions, cause,
                     [&] { Simulation(deformable, {}, jakobsen(options)); });
        expect_error(ErrorCode::InvalidOptions, "newton",
                     [&] { Simulation(deformable, {}, jakobsen(options)); });
    };
    const Deformable sheet = sheet_at(0, 1, 3);
    expect_refusal("has tetrahedra", make_soft_body(make_solid_box({1, 1, 1}, {1, 1, 1}), {}));
    Simulation simulation(sheet, {{.map = ExactMap::build(make_box({1, 1, 1}))}}, jakobsen());
    const TriangleMesh box = make_box({1, 1, 1});
    expect_error(ErrorCode::InvalidOptions, "cannot deform under the jakobsen solver",
                 [&] { simulation.set_collider_vertices(0, box.vertices); });
}

TEST(Jakobsen, RefusesToBeginWhereFloatsRoundGravityOff) {
    expect_error(ErrorCode::InvalidOptions, "begin nearer",
                 [] { Simulation(sheet_at(1000, 1, 3), {}, jakobsen()); });
    expect_error(ErrorCode::InvalidOptions, "begin nearer",
                 [] { Simulation(sheet_at(1, 1, 3), {}, jakobsen({.time_step = 1e-5})); });
    Simulation(sheet_at(1000, 1, 3), {}, jakobsen({.gravity = {}}));
}
