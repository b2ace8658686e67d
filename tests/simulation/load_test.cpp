// What deformables put on colliders: weights, friction, moments and momentum.

#include "support/draping.hpp"
#include "support/soft_bodies.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kStandardGravity = 9.81;

SimulationOptions measured(bool surfaces, bool small_steps = false) {
    SimulationOptions options{.thickness = 0.01, .surface_collision = surfaces, .self_collision = surfaces};
    options.measure_loads = true;
    if (small_steps) {
        options.solver = SolverKind::Xpbd;
        options.iteration_count = 1;
        options.substep_count = 10;
    }
    return options;
}

double mass_of(const Simulation& simulation) {
    double mass = 0;
    for (const float inverse : simulation.deformable().inverse_masses)
        mass += inverse > 0 ? 1 / double{inverse} : 0;
    return mass;
}

/// Its mean over some frames.
Load mean_load(Simulation& simulation, std::size_t collider, int frames = 60) {
    Load sum;
    for (int i = 0; i < frames; ++i) {
        simulation.step();
        sum.force += simulation.load_on(collider).force * (1.0 / frames);
        sum.torque += simulation.load_on(collider).torque * (1.0 / frames);
    }
    return sum;
}

Vec3d momentum_of(const Simulation& simulation) {
    const Deformable& d = simulation.deformable();
    Vec3d sum;
    for (std::size_t i = 0; i < d.particle_count(); ++i)
        if (d.inverse_masses[i] > 0)
            sum +=
                (Vec3d(d.positions[i]) - Vec3d(d.previous_positions[i])) * (1 / double{d.inverse_masses[i]});
    return sum * (simulation.options().substep_count / simulation.options().time_step);
}

/// @param most_left  of the momentum, as a share
void expect_balance(Simulation& simulation, int frame_count, double most_left) {
    const Vec3d before = momentum_of(simulation);
    Vec3d given;
    for (int i = 0; i < frame_count; ++i) {
        simulation.step();
        given += simulation.load_on(0).force * simulation.options().time_step;
    }
    const Vec3d left = momentum_of(simulation);
    EXPECT_LT(length(left), most_left * length(before));
    EXPECT_NEAR(length(given + left - before), 0, 0.01 * length(before));
}

} // namespace

TEST(Load, OfAClothAtRestIsItsWeight) {
    for (const bool surfaces : {false, true})
        for (const bool small_steps : {false, true}) {
            const std::vector<TriangleMesh> models{make_sphere(0.5, 40, 20)};
            Simulation simulation(sheet_at(0.55, 1.2, 25), colliders_of(models),
                                  measured(surfaces, small_steps));
            for (int i = 0; i < 1500 && !simulation.at_rest(); ++i) simulation.step();
            const double weight = mass_of(simulation) * kStandardGravity;
            const Load load = mean_load(simulation, 0);
            EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
            EXPECT_NEAR(std::hypot(load.force.x, load.force.y), 0, 0.02 * weight);
        }
}

TEST(Load, OfASoftBodyAtRestIsItsWeightWhereverItLies) {
    for (const bool surfaces : {false, true})
        for (const Vec3d& place : {Vec3d{}, Vec3d{0, 0, 2}, Vec3d{4, -3, 5}, Vec3d{-20, 0, 0}}) {
            const Deformable body = make_soft_body(
                make_solid_box({0.2, 0.2, 0.2}, {4, 4, 4}),
                {.young_modulus = 2e4, .damping = 0.02, .pose = {{}, place + Vec3d{0, 0, 0.165}}});
            std::vector<Collider> plate = colliders_of({make_box({1, 1, 0.1})});
            plate[0].pose.translation = place;
            Simulation simulation(body, plate, measured(surfaces, true));
            for (int i = 0; i < 240; ++i) simulation.step();
            const double weight = mass_of(simulation) * kStandardGravity;
            const Load load = mean_load(simulation, 0, 240);
            EXPECT_NEAR(load.force.z, -weight, 0.005 * weight) << "at " << place.x << ' ' << place.z;
            EXPECT_NEAR(std::hypot(load.force.x, load.force.y), 0, 0.005 * weight);
        }
}

TEST(Load, HasTheMomentOfWhereTheClothLies) {
    Deformable sheet = sheet_at(0.07, 0.4, 10);
    for (Vec3f& p : sheet.positions) p += Vec3f{0.6F, -0.2F, 0};
    sheet.previous_positions = sheet.positions;
    Simulation simulation(sheet, colliders_of({make_box({2, 2, 0.1})}), measured(true));
    for (int i = 0; i < 300; ++i) simulation.step();
    const double weight = mass_of(simulation) * kStandardGravity;
    const Load load = mean_load(simulation, 0);
    // r x F with r = (0.6, -0.2, 0.06) and F = (0, 0, -weight).
    EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.x, 0.2 * weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.y, 0.6 * weight, 0.02 * weight);
    EXPECT_NEAR(load.torque.z, 0, 0.02 * weight);
}

TEST(Load, IsSharedByTwoTablesHalfEach) {
    const std::vector<TriangleMesh> tables{make_box({0.4, 1, 0.1}), make_box({0.4, 1, 0.1})};
    std::vector<Collider> colliders = colliders_of(tables);
    colliders[0].pose.translation = {-0.3, 0, 0};
    colliders[1].pose.translation = {0.3, 0, 0};
    Simulation simulation(sheet_at(0.07, 0.8, 20), colliders, measured(true));
    for (int i = 0; i < 1200; ++i) simulation.step();
    const double weight = mass_of(simulation) * kStandardGravity;
    Vec3d left, right;
    for (int i = 0; i < 60; ++i) {
        simulation.step();
        left += simulation.load_on(0).force * (1.0 / 60);
        right += simulation.load_on(1).force * (1.0 / 60);
    }
    EXPECT_NEAR(left.z, -weight / 2, 0.02 * weight);
    EXPECT_NEAR(right.z, -weight / 2, 0.02 * weight);
    // The cloth sags between them and pulls them together.
    EXPECT_GE(left.x, -0.01 * weight);
    EXPECT_NEAR(left.x, -right.x, 0.03 * weight);
}

TEST(Load, BalancesTheMomentumOfAnImpact) {
    SimulationOptions options = measured(true);
    options.gravity = {};
    options.drag = 0;
    Simulation simulation(sheet_at(0.3, 1, 20, {0, 0, -3.0 / 240}), colliders_of({make_sphere(0.2, 24, 12)}),
                          options);
    expect_balance(simulation, 120, 0.9);
}

TEST(Load, OfAFastImpactIsWhatTheClothLosesThoughItsFramesAreDivided) {
    for (const bool small_steps : {false, true}) {
        SimulationOptions options = measured(true, small_steps);
        options.gravity = {};
        options.drag = 0;
        Simulation simulation(sheet_at(0.3, 1, 20, {0, 0, -20.0 / 240 / options.substep_count}),
                              colliders_of({make_sphere(0.2, 24, 12)}), options);
        expect_balance(simulation, 30, 0.97);
    }
}

TEST(Load, OfAClothThatHangsFromItIsItsWeight) {
    Deformable sheet = sheet_at(1, 0.6, 12);
    std::uint32_t held = 0;
    for (std::uint32_t i = 0; i < 12; ++i, ++held) {
        sheet.inverse_masses[i] = 0;
        sheet.attachments.push_back({i, 0});
    }
    for (const bool small_steps : {false, true}) {
        SimulationOptions options = measured(false, small_steps);
        options.drag = 0.02;
        Simulation simulation(sheet, colliders_of({make_box({0.1, 0.1, 0.1})}), options);
        for (int i = 0; i < 2400; ++i) simulation.step();
        const double weight = mass_of(simulation) * kStandardGravity;
        EXPECT_NEAR(mean_load(simulation, 0, 240).force.z, -weight, 0.02 * weight);
    }
}

TEST(Load, OfFrictionIsAgainstTheMotion) {
    // A belt under a sheet that is held back by nothing but its inertia: it takes friction times weight.
    const TriangleMesh belt = make_box({40, 2, 0.1});
    std::vector<Collider> colliders = colliders_of({belt});
    colliders[0].linear_velocity = {8, 0, 0};
    SimulationOptions options = measured(false);
    options.drag = 0;
    options.friction = 0.3;
    Simulation simulation(sheet_at(0.0601, 0.5, 10), colliders, options);
    for (int i = 0; i < 60; ++i) simulation.step();
    const double weight = mass_of(simulation) * kStandardGravity;
    const Load load = mean_load(simulation, 0, 60);
    EXPECT_NEAR(load.force.z, -weight, 0.02 * weight);
    EXPECT_NEAR(load.force.x, -0.3 * weight, 0.02 * weight);
}

TEST(Load, LeavesTheSimulationAsItIs) {
    SimulationOptions options = measured(true);
    const std::vector<Collider> ball = colliders_of({make_sphere(0.4, 24, 12)});
    Simulation with(sheet_at(0.45, 1, 15), ball, options);
    options.measure_loads = false;
    Simulation without(sheet_at(0.45, 1, 15), ball, options);
    for (int i = 0; i < 100; ++i) {
        with.step();
        without.step();
        ASSERT_EQ(with.state_hash(), without.state_hash());
    }
    EXPECT_EQ(without.load_on(0).force, Vec3d{});
    EXPECT_NE(with.load_on(0).force, Vec3d{});
}
