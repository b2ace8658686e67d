#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace echinus;
using namespace echinus::test;

namespace {

const SimulationOptions kWithoutForces{
    .solver = NewtonOptions{.air_drag = 0}, .time_step = 0.01, .gravity = {}};

constexpr std::array kBothSolvers{SolverKind::Jakobsen, SolverKind::Newton};

SimulationOptions without_forces(SolverKind solver) {
    SimulationOptions options = kWithoutForces;
    if (solver == SolverKind::Jakobsen) options.solver = JakobsenOptions{.drag = 0};
    return options;
}

/// A sheet in the plane z = 0 around the origin.
Simulation sheet(const SimulationOptions& options, std::vector<std::uint32_t> pins = {}) {
    return Simulation(make_cloth({.column_count = 6, .row_count = 6, .pins = std::move(pins)}), {}, options);
}

Vec3d mean_velocity(const Simulation& simulation) {
    const Deformable& d = simulation.deformable();
    Vec3d sum;
    for (std::size_t i = 0; i < d.particle_count(); ++i) sum += Vec3d(d.velocities[i]);
    return sum * (1.0 / static_cast<double>(d.particle_count()));
}

} // namespace

TEST(Steering, GivesAParticleItsVelocity) {
    Simulation simulation({.positions = {{1, 2, 3}}, .inverse_masses = {1}, .constraints = {}, .faces = {}},
                          {}, kWithoutForces);
    simulation.set_particle_velocity(0, {10, 0, -20});
    simulation.step();
    EXPECT_NEAR(simulation.positions()[0].x, 1.1, 1e-6);
    EXPECT_NEAR(simulation.positions()[0].z, 2.8, 1e-6);
    EXPECT_NEAR(simulation.largest_speed(), std::sqrt(500), 1e-3);
}

TEST(Steering, LeavesAPinnedParticleWhereItIs) {
    Simulation simulation = sheet(kWithoutForces, {0});
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
    for (const SimulationOptions& options :
         {jakobsen(), SimulationOptions{.solver = NewtonOptions{.collision = CollisionMode::Surfaces}}}) {
        Simulation simulation(make_cloth(cloth), {collider}, options);
        for (int i = 0; i < 50; ++i) {
            const std::size_t grabbed = 190;
            // Through the ring's tube to the other side.
            const Vec3d way = Vec3d{1, 0, -2} - Vec3d(simulation.positions()[grabbed]);
            simulation.set_particle_velocity(grabbed, way * (0.2 / simulation.options().time_step));
            simulation.step();
        }
        for (const Vec3f& position : simulation.positions()) EXPECT_FALSE(contains(collider, position));
        EXPECT_EQ(simulation.profile().lost_count, 0u);
    }
}

TEST(Steering, WindAcrossASheetCarriesItAlongInTheEnd) {
    for (const SolverKind solver : kBothSolvers) {
        Simulation simulation = sheet(without_forces(solver));
        for (int i = 0; i < 300; ++i) {
            simulation.blow({0, 0, 2}, 5);
            simulation.step();
        }
        EXPECT_NEAR(mean_velocity(simulation).z, 2, 0.01);
    }
}

TEST(Steering, WindGivesItsShareInOneFrame) {
    for (const SolverKind solver : kBothSolvers) {
        Simulation simulation = sheet(without_forces(solver));
        simulation.blow({3, -1, 2}, 5);
        simulation.step();
        // Along the sheet, air slips by.
        const Vec3d velocity = mean_velocity(simulation);
        EXPECT_NEAR(velocity.x, 0, 1e-5);
        EXPECT_NEAR(velocity.y, 0, 1e-5);
        EXPECT_NEAR(velocity.z, 5 * 0.01 * 2, 1e-5);
    }
}

TEST(Steering, AirAtRestBrakesAndNeverTurnsRound) {
    for (const SolverKind solver : kBothSolvers) {
        Simulation simulation = sheet(without_forces(solver));
        for (std::size_t i = 0; i < simulation.positions().size(); ++i)
            simulation.set_particle_velocity(i, {0, 0, 1});
        simulation.blow({}, 1e9);
        simulation.step();
        EXPECT_NEAR(mean_velocity(simulation).z, 0, 1e-5);
    }
}

TEST(Steering, WindOfTheOptionsBlowsInEveryFrameInWhichTheHostDoesNot) {
    for (const SolverKind solver : kBothSolvers) {
        const SimulationOptions still = without_forces(solver);
        SimulationOptions windy = still;
        windy.wind = {0, 0, 2};
        windy.wind_rate = 5;
        Simulation blown = sheet(still), in_wind = sheet(windy);
        for (int i = 0; i < 20; ++i) {
            blown.blow(i == 7 ? Vec3d{0, 0, -9} : windy.wind, i == 7 ? 1 : 5);
            if (i == 7) {
                in_wind.blow({0, 0, -9}, 1);
                Simulation other = sheet(windy);
                other.restore_state(in_wind.save_state());
                in_wind = other;
            }
            blown.step();
            in_wind.step();
            ASSERT_EQ(blown.state_hash(), in_wind.state_hash()) << i;
        }
        EXPECT_GT(mean_velocity(in_wind).z, 0.1);
    }
}

// ---- Colliders

namespace {

void expect_pose(const RigidTransform& pose, const RigidTransform& expected) {
    for (const Vec3d& point : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
        EXPECT_NEAR(length(pose.to_world(point) - expected.to_world(point)), 0, 1e-11);
}

} // namespace

TEST(Steering, LeadsAColliderToAPoseInOneFrameAndLeavesItThere) {
    for (const bool surfaces : {false, true}) {
        const SimulationOptions options =
            without_forces(surfaces ? SolverKind::Newton : SolverKind::Jakobsen);
        Simulation simulation(sheet_at(5, 1, 4), colliders_of({make_box({1, 1, 1})}), options);
        const RigidTransform goal{Rotation::about({1, 2, 3}, 2), {0.5, -1, 0.25}};
        simulation.set_collider_velocity(0, {100, 0, 0}, {});
        simulation.set_collider_pose(0, goal);
        simulation.step();
        expect_pose(simulation.colliders()[0].pose, goal);
        EXPECT_NEAR(simulation.colliders()[0].linear_velocity.y, -1 / 0.01, 1e-9);
        const RigidTransform there = simulation.colliders()[0].pose;
        simulation.step();
        EXPECT_EQ(simulation.colliders()[0].pose.translation, there.translation);
        EXPECT_FALSE(simulation.colliders()[0].moves());
        simulation.set_collider_velocity(0, {0, 0, 2}, {});
        simulation.step();
        simulation.step();
        expect_pose(simulation.colliders()[0].pose, {goal.rotation, goal.translation + Vec3d{0, 0, 0.04}});
    }
}

TEST(Steering, LeadsAColliderAlongKeysAndRestsNotBeforeTheLast) {
    const std::vector<PoseKey> keys{{0, {}}, {0.1, {{}, {0, 0, 1}}}, {3, {{}, {0, 0, 1}}}};
    SimulationOptions options = kWithoutForces;
    options.newton().collision = CollisionMode::Surfaces;
    options.rest.frame_count = 5;
    Simulation simulation(sheet_at(5, 1, 4), colliders_of({make_box({1, 1, 1})}), options);
    simulation.set_collider_keyframes(0, keys);
    for (int frame = 1; frame <= 300; ++frame) {
        simulation.step();
        expect_pose(simulation.colliders()[0].pose, pose_at(keys, frame * 0.01));
        ASSERT_EQ(simulation.at_rest(), frame == 300) << frame;
    }
    EXPECT_FALSE(simulation.colliders()[0].moves());
}

TEST(Steering, TakesASheetAlongOnATrayThatTurnsAndHaltsWithoutMeetingIt) {
    // Back and forth by 30 degrees and 0.2 units in a quarter of a second each, up, and down again.
    const TriangleMesh tray = make_box({1, 1, 0.1});
    std::vector<PoseKey> keys;
    for (int i = 0; i < 7; ++i)
        keys.push_back({0.25 * i,
                        {Rotation::about({0, 0, 1}, (i % 2) * std::numbers::pi / 6),
                         {0.2 * (i % 2), 0, i == 3 ? 0.3 : 0.1 * (i % 3)}}});
    SimulationOptions options{.thickness = 0.01};
    Simulation simulation(sheet_at(0.065, 0.6, 16), colliders_of({tray}), options);
    simulation.set_collider_keyframes(0, keys);
    expect_nothing_meets(simulation, {tray}, 100);
}

TEST(Steering, RefusesPosesAndKeysThatMakeNoSense) {
    Simulation simulation(sheet_at(5, 1, 4), colliders_of({make_box({1, 1, 1}), make_box({1, 1, 1})}),
                          jakobsen());
    const double infinity = std::numeric_limits<double>::infinity();
    const auto refuse = [](const std::string& words, const auto& call) {
        expect_error(ErrorCode::InvalidOptions, words, call);
    };
    refuse("collider 1 has a translation that is not finite", [&] {
        simulation.set_collider_pose(1, {{}, {0, infinity, 0}});
    });
    refuse("collider 1 has the rotation", [&] { simulation.set_collider_pose(1, {{2, 0, 0, 0}, {}}); });
    refuse("collider 1: keyframe 2 is at 1.500000 s, not later than the one before it, at 2.000000 s; times "
           "must "
           "ascend",
           [&] {
               simulation.set_collider_keyframes(1, {{0, {}}, {2, {}}, {1.5, {}}});
           });
    refuse("keyframe 1 is at", [&] { simulation.set_collider_keyframes(1, {{0, {}}, {0, {}}}); });
    refuse("collider 1: keyframe 0 has a time that is not finite", [&] {
        simulation.set_collider_keyframes(1, {{std::nan(""), {}}});
    });
    refuse("collider 1: keyframe 1 has the rotation", [&] {
        simulation.set_collider_keyframes(1, {{0, {}}, {1, {{0, 0, 0, 0}, {}}}});
    });
    // Nothing is lost: the collider rests where it was.
    simulation.step();
    EXPECT_EQ(simulation.colliders()[1].pose.translation, Vec3d{});
}
