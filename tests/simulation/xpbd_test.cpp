// What extended position-based dynamics promises: sticks are springs, whatever the number of relaxations and
// the time step.

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace echinus;

namespace {

constexpr double kGravity = 10;
constexpr double kFilmThickness = 0.01;

SimulationOptions small_steps(std::uint32_t substep_count = 10) {
    return {.solver = SolverKind::Xpbd, .iteration_count = 1, .substep_count = substep_count};
}

/// Particles of one mass below each other, 0.1 apart; the first is pinned.
Deformable chain(std::size_t particle_count, float mass) {
    Deformable chain;
    for (std::size_t i = 0; i < particle_count; ++i) {
        chain.positions.push_back({0, 0, -0.1F * float(i)});
        chain.inverse_masses.push_back(i == 0 ? 0 : 1 / mass);
    }
    for (std::uint32_t i = 0; i + 1 < particle_count; ++i)
        chain.sticks.push_back({i, i + 1, 0.1F, StickKind::Structural});
    chain.previous_positions = chain.positions;
    return chain;
}

/// How far the end of a chain hangs below its length, once it hangs still. Drag counts per frame, and so does
/// the time that this takes.
double sag(const Deformable& chain, SimulationOptions options, int frame_count) {
    options.gravity = {0, 0, -kGravity};
    options.drag = 0.05;
    options.bound = 100;
    Simulation simulation(chain, {}, options);
    for (int i = 0; i < frame_count; ++i) simulation.step();
    return chain.positions.back().z - simulation.positions().back().z;
}

/// Of motion and of springs.
double energy_of_cloth(const Simulation& simulation) {
    const SimulationOptions& options = simulation.options();
    const Deformable& d = simulation.deformable();
    const double substep = options.time_step / options.substep_count;
    double sum = 0;
    for (std::size_t i = 0; i < d.particle_count(); ++i) {
        const double speed = length(Vec3d(d.positions[i]) - Vec3d(d.previous_positions[i])) / substep;
        sum += speed * speed / d.inverse_masses[i] / 2;
    }
    for (const Stick& stick : d.sticks) {
        const double compliance = options.compliance[static_cast<std::size_t>(stick.kind)];
        if (compliance == 0) continue;
        const double error =
            length(Vec3d(d.positions[stick.b]) - Vec3d(d.positions[stick.a])) - double{stick.rest_length};
        sum += error * error / compliance / 2;
    }
    return sum;
}

std::size_t inside_count(const Simulation& simulation, const TriangleMesh& mesh) {
    return static_cast<std::size_t>(
        std::count_if(simulation.positions().begin(), simulation.positions().end(),
                      [&](const Vec3f& p) { return winding_number(mesh, Vec3d(p)) > 0.5; }));
}

} // namespace

TEST(Xpbd, HangsAMassFromASpringAsLowAsHookeSays) {
    for (const float mass : {0.5F, 3.0F})
        for (const double compliance : {1e-5, 1e-3})
            for (const double time_step : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
                for (const std::uint32_t iterations : {1U, 3U, 20U})
                    for (const std::uint32_t substeps : {1U, 4U}) {
                        const SimulationOptions options{.solver = SolverKind::Xpbd,
                                                        .time_step = time_step,
                                                        .iteration_count = iterations,
                                                        .substep_count = substeps,
                                                        .compliance = {compliance, 0, 0}};
                        const double expected = mass * kGravity * compliance;
                        EXPECT_NEAR(sag(chain(2, mass), options, 1000), expected, 0.01 * expected + 1e-6)
                            << "mass " << mass << ", compliance " << compliance << ", step " << time_step
                            << ", " << iterations << " iterations, " << substeps << " substeps";
                    }
}

TEST(Xpbd, HangsAChainEquallyLowForAnyNumberOfIterationsAndAnyTimeStep) {
    constexpr double kCompliance = 1e-3;
    const double expected = kGravity * kCompliance * (5 + 4 + 3 + 2 + 1);
    for (const double time_step : {1.0 / 240, 1.0 / 1000})
        for (const std::uint32_t iterations : {5U, 20U, 80U}) {
            const SimulationOptions options{.solver = SolverKind::Xpbd,
                                            .time_step = time_step,
                                            .iteration_count = iterations,
                                            .compliance = {kCompliance, 0, 0}};
            EXPECT_NEAR(sag(chain(6, 1), options, 5000), expected, 0.02 * expected);
        }
}

TEST(Xpbd, IsNeededForThatSinceSticksBecomeStifferWithEveryIteration) {
    const auto sag_of_sticks = [](std::uint32_t iterations) {
        return sag(chain(6, 1), {.iteration_count = iterations, .stiffness = {0.05, 0, 0}}, 1200);
    };
    EXPECT_GT(sag_of_sticks(2), 3 * sag_of_sticks(20));
}

TEST(Xpbd, SwingsWithThePeriodOfTheSpring) {
    // T = 2 pi sqrt(m c): 0.281 s.
    constexpr double kCompliance = 1e-3;
    constexpr double kMass = 2;
    Deformable spring = chain(2, kMass);
    spring.positions[1].z -= 0.02F;
    spring.previous_positions = spring.positions;
    Simulation simulation(spring, {},
                          {.solver = SolverKind::Xpbd,
                           .time_step = 1.0 / 1000,
                           .iteration_count = 1,
                           .substep_count = 10,
                           .gravity = {},
                           .drag = 0,
                           .compliance = {kCompliance, 0, 0}});
    int crossings = 0;
    float before = -1;
    const int frame_count = 2810;
    for (int i = 0; i < frame_count; ++i) {
        simulation.step();
        const float now = simulation.positions()[1].z + 0.1F;
        crossings += before < 0 && now >= 0 ? 1 : 0;
        before = now;
    }
    const double periods = frame_count / 1000.0 / (2 * 3.14159265 * std::sqrt(kMass * kCompliance));
    EXPECT_NEAR(crossings, periods, 1);
}

TEST(Xpbd, AddsNoEnergyToAFreeSheet) {
    for (const std::array<double, kStickKindCount>& compliance :
         {std::array{1e-6, 1e-5, 1e-3}, std::array{1e-3, 1e-2, 1e-1}, std::array{0.0, 0.0, 0.0}}) {
        test::Random random(11);
        Deformable sheet = test::sheet_at(0, 1, 12);
        for (Vec3f& previous : sheet.previous_positions) previous += test::in_cube(random, 0.001F);
        SimulationOptions options = small_steps();
        options.gravity = {};
        options.drag = 0;
        options.compliance = compliance;
        Simulation simulation(sheet, {}, options);
        const double start = energy_of_cloth(simulation);
        for (int i = 0; i < 1000; ++i) {
            simulation.step();
            ASSERT_LE(energy_of_cloth(simulation), 1.05 * start) << "frame " << i;
        }
    }
}

TEST(Xpbd, StretchesAHangingSheetLessInSubstepsThanInIterations) {
    // Macklin et al. 2019: the same work, another order.
    const auto stretch = [](SimulationOptions options) {
        Deformable sheet = test::sheet_at(0, 1, 20);
        for (std::size_t i = 0; i < 20; ++i) sheet.inverse_masses[i] = 0;
        options.compliance = {0, 0, 0};
        options.drag = 0.05;
        Simulation simulation(sheet, {}, options);
        for (int i = 0; i < 400; ++i) simulation.step();
        double largest = 0;
        for (const Stick& stick : sheet.sticks)
            largest = std::max(
                largest, double{length(simulation.positions()[stick.b] - simulation.positions()[stick.a])} /
                                 stick.rest_length -
                             1);
        return largest;
    };
    SimulationOptions iterations = small_steps(1);
    iterations.iteration_count = 20;
    EXPECT_LT(stretch(small_steps(20)), stretch(iterations) / 4);
}

TEST(Xpbd, DrapesASheetOverASphereAndABoxWithNoneInside) {
    for (const TriangleMesh& mesh : {make_sphere(0.5, 60, 30), make_box({0.8, 0.8, 0.8})}) {
        SimulationOptions options = small_steps();
        options.thickness = kFilmThickness;
        options.friction = 0.8;
        options.drag = 0.02; // the corners swing, and small steps damp them little
        Simulation simulation(test::sheet_at(0.55, 1.2, 17), {{.map = ExactMap::build(mesh)}}, options);
        while (!simulation.at_rest() && simulation.frame() < 2000) {
            simulation.step();
            if (simulation.frame() % 50 == 0) ASSERT_EQ(inside_count(simulation, mesh), 0u);
        }
        EXPECT_TRUE(simulation.at_rest()) << simulation.largest_speed();
        EXPECT_EQ(inside_count(simulation, mesh), 0u);
        EXPECT_EQ(simulation.profile().lost_count, 0u);
        EXPECT_GT(simulation.profile().contact_count, 0u);
    }
}

TEST(Xpbd, LosesNoParticleOfAFastSheetToAThinPlateThatMovesAndTurnsFast) {
    const Collider plate{.map = ExactMap::build(make_box({1.5, 1.5, 0.001})),
                         .linear_velocity = {0.5, 0, 5},
                         .angular_velocity = {4, 18, 2}};
    for (const std::uint32_t substeps : {1U, 4U, 16U}) {
        SimulationOptions options = small_steps(substeps);
        options.thickness = kFilmThickness;
        const Vec3d step = Vec3d{0, 0, -30} * (options.time_step / substeps);
        Simulation simulation(test::sheet_at(0.7, 1, 25, step), {plate}, options);
        for (int frame = 0; frame < 240; ++frame) {
            const std::vector<Vec3f> before(simulation.positions().begin(), simulation.positions().end());
            const RigidTransform pose_before = simulation.colliders()[0].pose;
            simulation.step();
            for (std::size_t i = 0; i < before.size(); ++i)
                ASSERT_FALSE(
                    sweep(simulation.colliders()[0], pose_before, before[i], simulation.positions()[i])
                        .found());
        }
        EXPECT_EQ(simulation.profile().lost_count, 0u);
        EXPECT_GT(simulation.profile().contact_count, 0u);
    }
}

TEST(Xpbd, CarriesTurnsAndLiftsASheetAlongWithItsCollider) {
    const Collider box{.map = ExactMap::build(make_box({2, 2, 1})),
                       .linear_velocity = {0.2, 0, 0.3},
                       .angular_velocity = {0, 0, 1}};
    SimulationOptions options = small_steps();
    options.thickness = kFilmThickness;
    options.friction = 0.8;
    Simulation simulation(test::sheet_at(0.5 + kFilmThickness, 0.3, 7), {box}, options);
    const Vec3f corner = simulation.positions()[0];
    for (int i = 0; i < 240; ++i) simulation.step();
    const Vec3d expected = simulation.colliders()[0].pose.to_world(Vec3d(corner));
    EXPECT_NEAR(length(Vec3d(simulation.positions()[0]) - expected), 0, 0.02);
}

TEST(Xpbd, GivesTheSameBitsOnEveryRunInEveryCopyAndUnderEachInstructionSet) {
    const ExactMap torus = ExactMap::build(make_torus(1, 0.4, 30, 16));
    const auto start = [&] {
        const Collider collider{.map = torus, .angular_velocity = {0.2, 0.1, 0.5}};
        SimulationOptions options = small_steps(5);
        options.iteration_count = 2;
        options.thickness = kFilmThickness;
        return Simulation(test::sheet_at(0.45, 2, 20), {collider}, options);
    };
    std::vector<std::uint64_t> hashes;
    test::under_each_instruction_set([&](std::string_view) {
        Simulation simulation = start();
        for (int i = 0; i < 40; ++i) simulation.step();
        Simulation copy = simulation;
        for (int i = 0; i < 20; ++i) simulation.step();
        for (int i = 0; i < 20; ++i) copy.step();
        hashes.push_back(simulation.state_hash());
        hashes.push_back(copy.state_hash());
    });
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(Xpbd, FallsAsFarInAnyNumberOfSubsteps) {
    // From rest, n steps of h fall by g h^2 n (n + 1) / 2.
    for (const std::uint32_t substeps : {1U, 10U}) {
        SimulationOptions options = small_steps(substeps);
        options.time_step = 0.01;
        options.gravity = {0, 0, -kGravity};
        options.drag = 0;
        Deformable particle = chain(1, 1);
        particle.inverse_masses = {1};
        Simulation simulation(particle, {}, options);
        for (int i = 0; i < 100; ++i) simulation.step();
        const double n = 100.0 * substeps, h = 0.01 / substeps;
        EXPECT_NEAR(simulation.positions()[0].z, -kGravity * h * h * n * (n + 1) / 2, 0.01);
        EXPECT_NEAR(simulation.largest_speed(), kGravity, 0.02);
    }
}

TEST(Xpbd, RefusesSubstepsOfTheVerletSolverAndNegativeCompliance) {
    const Deformable particle = chain(2, 1);
    test::expect_error(ErrorCode::InvalidOptions, "substep_count is 3; it must be 1",
                       [&] { Simulation(particle, {}, {.substep_count = 3}); });
    test::expect_error(ErrorCode::InvalidOptions, "substep_count is 0",
                       [&] { Simulation(particle, {}, {.solver = SolverKind::Xpbd, .substep_count = 0}); });
    test::expect_error(ErrorCode::InvalidOptions, "compliance", [&] {
        Simulation(particle, {}, {.solver = SolverKind::Xpbd, .compliance = {0, -1, 0}});
    });
}

namespace {

/// How far a sheet that begins with such a speed goes along x on a box that goes along x, with a friction of
/// 0.3.
/// @param x  of the box's middle
double slid_on_box(const ColliderMap& box, double x, double speed, double box_speed, double seconds,
                   SimulationOptions options) {
    options.thickness = kFilmThickness;
    options.friction = 0.3;
    options.drag = 0;
    Deformable sheet = test::sheet_at(0.5 + kFilmThickness, 0.3, 5);
    for (Vec3f& p : sheet.positions) p = Vec3f(Vec3d(p) + Vec3d{x, 0, 0});
    sheet.previous_positions = sheet.positions;
    const Collider collider{.map = box, .pose = {{}, {x, 0, 0}}, .linear_velocity = {box_speed, 0, 0}};
    Simulation simulation(sheet, {collider}, options);
    for (std::size_t i = 0; i < sheet.particle_count(); ++i)
        simulation.set_particle_velocity(i, {speed, 0, 0});
    const auto before = simulation.positions();
    const float from = before[12].x;
    for (int frame = 0; frame < seconds / options.time_step; ++frame) simulation.step();
    return double{simulation.positions()[12].x - from};
}

} // namespace

TEST(Xpbd, FrictionTakesAsMuchFarFromTheOriginAsAtIt) {
    const TriangleMesh mesh = make_box({12, 2, 1});
    const ExactMap exact = ExactMap::build(mesh);
    const DistanceMap rays = DistanceMap::build(mesh);
    const double grip = 0.3 * 9.81;
    for (const std::uint32_t substeps : {10u, 40u})
        for (const double x : {0.0, 2.0, 20.0, 100.0}) {
            const auto expect_as_coulomb_says = [&](const ColliderMap& box, bool surfaces) {
                SimulationOptions options = small_steps(substeps);
                options.surface_collision = options.self_collision = surfaces;
                const double stop = 2.0 * 2.0 / (2 * grip), start = 1 - 1 / (2 * grip);
                EXPECT_NEAR(slid_on_box(box, x, 2, 0, 1, options), stop, 0.05 * stop) << x << ' ' << substeps;
                EXPECT_NEAR(slid_on_box(box, x, 0, 1, 1, options), start, 0.05 * start)
                    << x << ' ' << substeps;
            };
            expect_as_coulomb_says(exact, false);
            expect_as_coulomb_says(exact, true);
            expect_as_coulomb_says(rays, false);
        }
}
