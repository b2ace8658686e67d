// The newton solver as a user sees it: strain, friction, contact, motion.

#include "support/custom_maps.hpp"
#include "support/draping.hpp"
#include "support/surface_judge.hpp"

#include <echinus/mesh.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

namespace echinus::test {
namespace {

constexpr double kEarthGravity = 9.81;

SimulationOptions newton() {
    SimulationOptions options;
    options.newton().air_drag = 0;
    return options;
}

SimulationOptions newton_contact(double thickness) {
    SimulationOptions options = newton();
    options.thickness = thickness;
    return options;
}

Vec3d middle_of(const Simulation& simulation) {
    Vec3d sum;
    for (const Vec3f& place : simulation.positions()) sum += Vec3d(place);
    return sum * (1.0 / static_cast<double>(simulation.positions().size()));
}

/// A sheet of a metre that hangs by its first row, where it comes to rest.
Simulation hanging_sheet(std::uint32_t count, SimulationOptions options, int frame_count) {
    ClothOptions cloth{.column_count = count, .row_count = count};
    cloth.pose.rotation = Rotation::about({1, 0, 0}, -std::numbers::pi / 2);
    for (std::uint32_t i = 0; i < count; ++i) cloth.pins.push_back(i);
    options.newton().material.damping = 0.2; // to come to rest soon
    Simulation simulation(make_cloth(cloth), {}, options);
    for (int i = 0; i < frame_count; ++i) simulation.step();
    return simulation;
}

/// Of the rows beside the first: how much longer the vertical edges are than at rest.
double strain_at_the_top(const Simulation& simulation, std::uint32_t count) {
    double sum = 0;
    for (std::uint32_t column = 0; column < count; ++column)
        sum += length(Vec3d(simulation.positions()[count + column]) - Vec3d(simulation.positions()[column])) *
                   (count - 1) -
               1;
    return sum / count;
}

TEST(Newton, ClothThatHangsIsStretchedAsItsMaterialSaysAtEveryResolution) {
    const SimulationOptions options = newton();
    for (const std::uint32_t count : {9U, 17U, 33U}) {
        const Simulation simulation = hanging_sheet(count, options, 240);
        // The length that hangs below the middle of the first row's squares.
        const double below = 1 - 0.5 / (count - 1);
        const double expected = options.newton().material.density * kEarthGravity * below /
                                options.newton().material.stretch_stiffness;
        EXPECT_NEAR(strain_at_the_top(simulation, count) / expected, 1, 0.02) << count;
    }
}

TEST(Newton, ClothThatHangsIsStretchedTheSameAtEveryStep) {
    std::vector<double> strains;
    for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
        SimulationOptions options = newton();
        options.time_step = step;
        strains.push_back(strain_at_the_top(hanging_sheet(13, options, static_cast<int>(4 / step)), 13));
    }
    EXPECT_NEAR(strains[0] / strains[1], 1, 0.01);
    EXPECT_NEAR(strains[2] / strains[1], 1, 0.01);
}

TEST(Newton, ClothInFreeFallKeepsItsMomentumToTheTolerance) {
    Deformable sheet = sheet_at(1, 1, 12);
    for (const Vec3f& p : sheet.positions) // a spin about a diagonal, and a throw
        sheet.velocities.push_back({0.5F, -0.2F, 0.3F * p.x});
    SimulationOptions options = newton();
    options.gravity = {};
    Simulation simulation(sheet, {}, options);
    const Vec3d before = middle_of(simulation);
    for (int i = 0; i < 60; ++i) simulation.step();
    const Vec3d moved = middle_of(simulation) - before;
    EXPECT_NEAR(moved.x, 0.5, 1e-3);
    EXPECT_NEAR(moved.y, -0.2, 1e-3);
}

/// A strip of cloth that hangs by one end and swings as a pendulum: the height of its middle over the lowest.
TEST(Newton, APendulumOfClothKeepsNineTenthsOfItsAmplitudeOverTenSwings) {
    ClothOptions strip{.column_count = 2, .row_count = 9, .width = 0.1, .height = 1};
    strip.pins = {0, 1};
    strip.pose.rotation = Rotation::about({1, 0, 0}, -std::numbers::pi / 2 + 0.1);
    SimulationOptions options = newton();
    options.newton().material.damping = 0;
    options.newton().material.bending_stiffness = 1; // a rod: else energy goes from one mode to others
    Simulation simulation(make_cloth(strip), {}, options);
    const double period = 2 * std::numbers::pi * std::sqrt(2.0 / 3 / kEarthGravity); // of a rod
    const auto swing = [&](double seconds) {
        double most = 0;
        for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
            simulation.step();
            most = std::max(
                most, std::abs(double{simulation.positions()[17].y} - double{simulation.positions()[0].y}));
        }
        return most;
    };
    const double first = swing(period);
    swing(8 * period);
    const double last = swing(period);
    EXPECT_GT(last, 0.9 * first);
    EXPECT_LE(last, first);
}

TEST(Newton, FrictionHoldsOnASlopeJustBelowItsAngleAndSlidesJustAbove) {
    const auto crept = [](double degrees, double friction, int frames) {
        const Rotation tilt = Rotation::about({1, 0, 0}, degrees * std::numbers::pi / 180);
        const Deformable sheet = sheet_on_slope(tilt, 0.503);
        SimulationOptions options = newton_contact(0.004);
        options.friction = friction;
        Simulation simulation(sheet, {{.map = ExactMap::build(make_box({4, 4, 1})), .pose = {tilt, {}}}},
                              options);
        // So near to the angle the speed of landing is lost slowly.
        for (int i = 0; i < 300; ++i) simulation.step();
        const Vec3d before = middle_of(simulation);
        for (int i = 0; i < frames; ++i) simulation.step();
        return length(middle_of(simulation) - before);
    };
    EXPECT_LT(crept(26.5, 0.5, 300), 1e-6);
    EXPECT_GT(crept(26.565, 0.49, 60), 0.02); // 0.044 by Coulomb's law
}

TEST(Newton, ClothBetweenPlatesThatLeaveItLittleRoomLiesStillUnderABoundedLoad) {
    constexpr double kThickness = 0.01, kGap = 0.6 * kThickness;
    std::vector<Collider> plates = colliders_of({make_box({1, 1, 0.1}), make_box({1, 1, 0.1})});
    plates[1].pose.translation.z = 0.1 + kGap;
    SimulationOptions options = newton_contact(kThickness);
    options.friction = 0.5;
    Simulation simulation(sheet_at(0.05 + kGap / 2, 0.8, 9), plates, options);
    for (int i = 0; i < 60; ++i) simulation.step();
    const double load = simulation.load_on(1).force.z;
    for (int i = 0; i < 60; ++i) simulation.step();
    EXPECT_NEAR(simulation.load_on(1).force.z, load, 0.01 * load);
    const double strength = options.newton().material.stretch_stiffness * 0.1; // strains one edge by 1
    EXPECT_LT(load, 2 * strength * 81);
    EXPECT_LT(simulation.largest_speed(), 1e-3);
}

TEST(Newton, ClothFallsOnABallAndBecomesSlowWithHardlyAnyStrain) {
    const TriangleMesh ball = make_sphere(0.3, 32, 16);
    SimulationOptions options = newton_contact(0.008);
    options.newton().air_drag = 1; // its folds would swing for long without air around them
    Simulation simulation(sheet_at(0.33, 0.8, 17), colliders_of({ball}), options);
    expect_nothing_meets(simulation, {ball}, 120);
    EXPECT_LT(simulation.residual().root_mean_square, 0.005);
    EXPECT_LT(simulation.residual().largest, 0.03);
    while (!simulation.at_rest() && simulation.frame() < 600) simulation.step();
    EXPECT_TRUE(simulation.at_rest());
}

TEST(Newton, AThinSheetWhoseMiddleLiesOnThePoleOfABallHangsDownAroundIt) {
    const TriangleMesh ball = make_sphere(0.3, 24, 12); // as symmetrical as the sheet
    Simulation simulation(sheet_at(0.4, 1, 11), colliders_of({ball}), newton_contact(0));
    expect_nothing_meets(simulation, {ball}, 60);
    EXPECT_LT(simulation.positions().front().z, 0);
}

TEST(Newton, LayersThatFallOnABoxLieOnEachOther) {
    std::vector<Deformable> layers;
    for (int i = 0; i < 3; ++i) layers.push_back(sheet_at(0.51 + 0.012 * i, 0.4, 7));
    const TriangleMesh box = make_box({2, 2, 1});
    Simulation simulation(combine(layers), colliders_of({box}), newton_contact(0.008));
    expect_nothing_meets(simulation, {box}, 90);
    EXPECT_GT(middle_of(simulation).z, 0.5);
    EXPECT_LT(simulation.largest_speed(), 0.01);
}

TEST(Newton, ABoxThatRisesAndTurnsLiftsTheClothThatLiesOnIt) {
    const TriangleMesh box = make_box({0.6, 0.6, 0.2});
    std::vector<Collider> colliders = colliders_of({box});
    colliders[0].linear_velocity = {0, 0, 0.5};
    colliders[0].angular_velocity = {0, 0, 1};
    Simulation simulation(sheet_at(0.107, 0.4, 9), colliders, newton_contact(0.006));
    expect_nothing_meets(simulation, {box}, 60);
    const Vec3f corner = simulation.positions()[0];
    EXPECT_NEAR(corner.z, 0.5 + 0.105, 0.01);
    // By friction it turns with the box: by a radian.
    const double turned = std::atan2(double{corner.y}, double{corner.x}) - std::atan2(-0.2, -0.2);
    EXPECT_NEAR(std::remainder(turned - 1, 2 * std::numbers::pi), 0, 0.05);
}

TEST(Newton, APlateThatStrikesASheetThrowsItWithoutAHole) {
    const TriangleMesh plate = make_box({0.3, 0.3, 0.02});
    for (const double speed : {4.0, 30.0}) {
        std::vector<Collider> colliders = colliders_of({plate});
        colliders[0].linear_velocity = {0, 0, speed};
        Simulation simulation(sheet_at(0.3, 0.8, 17), colliders, newton_contact(0.008));
        expect_nothing_meets(simulation, {plate}, 16);
    }
}

TEST(Newton, TheLoadOfAClothAtRestIsItsWeight) {
    SimulationOptions options = newton_contact(0.006);
    const TriangleMesh box = make_box({2, 2, 1});
    Simulation simulation(sheet_at(0.505, 0.5, 11), colliders_of({box}), options);
    for (int i = 0; i < 120; ++i) simulation.step();
    const double weight = options.newton().material.density * 0.25 * kEarthGravity;
    EXPECT_NEAR(simulation.load_on(0).force.z / weight, -1, 0.01);
}

TEST(Newton, AStripOfTwiceTheBendingStiffnessSagsHalfAsMuch) {
    const auto sag = [](double stiffness) {
        ClothOptions strip{.column_count = 3, .row_count = 11, .width = 0.04, .height = 0.2};
        strip.pins = {0, 1, 2, 3, 4, 5}; // clamped
        SimulationOptions options = newton();
        options.newton().material.bending_stiffness = stiffness;
        options.newton().material.damping = 0.1;
        Simulation simulation(make_cloth(strip), {}, options);
        for (int i = 0; i < 200; ++i) simulation.step();
        return double{simulation.positions()[0].z} - double{simulation.positions()[31].z};
    };
    EXPECT_NEAR(sag(0.02) / sag(0.04), 2, 0.05);
}

namespace {

/// A thread of one constraint of 0.1 m, whose upper end is pinned. The lower has half of its mass.
Deformable hanging_thread() {
    Deformable thread;
    thread.positions = {{0, 0, 0}, {0, 0, -0.1F}};
    thread.inverse_masses = {0, 1};
    thread.constraints = {{0, 1, 0.1F, ConstraintKind::Structural}};
    return thread;
}

/// Of a thread of one constraint, which is as wide as it is long.
double end_mass(const SimulationOptions& options) {
    return options.newton().material.density * 0.1 * 0.1 / 2;
}

} // namespace

TEST(Newton, AThreadHangsAsLowAsHookeSaysAtEveryStep) {
    for (const double step : {1.0 / 60, 1.0 / 240, 1.0 / 1000})
        for (const double stiffness : {1.0, 100.0}) {
            SimulationOptions options = newton();
            options.time_step = step;
            options.newton().air_drag = 20;
            options.newton().material.stretch_stiffness = stiffness;
            Simulation simulation(hanging_thread(), {}, options);
            while (simulation.frame() * step < 2) simulation.step();
            const double expected = end_mass(options) * kEarthGravity / stiffness;
            EXPECT_NEAR(-0.1 - double{simulation.positions()[1].z}, expected, 0.01 * expected + 1e-7);
        }
}

TEST(Newton, AThreadSwingsWithThePeriodOfItsSpring) {
    SimulationOptions options = newton();
    options.time_step = 1.0 / 1000;
    options.gravity = {};
    options.newton().material.stretch_stiffness = 1;
    options.newton().material.damping = 0;
    Deformable thread = hanging_thread();
    thread.positions[1].z -= 0.01F;
    Simulation simulation(thread, {}, options);
    int crossings = 0;
    float before = -1;
    for (int i = 0; i < 2000; ++i) {
        simulation.step();
        const float now = simulation.positions()[1].z + 0.1F;
        crossings += before < 0 && now >= 0 ? 1 : 0;
        before = now;
    }
    EXPECT_NEAR(crossings, 2 / (2 * std::numbers::pi * std::sqrt(end_mass(options))), 1);
}

namespace {

/// How far a sheet that begins with such a speed goes along x in a second on a box that goes along x, with a
/// friction of 0.3.
/// @param x  of the box's middle
double slid_on_box(const ExactMap& box, double x, double speed, double box_speed) {
    SimulationOptions options = newton_contact(0.01);
    options.friction = 0.3;
    Deformable sheet = sheet_at(0.51, 0.3, 5);
    for (Vec3f& p : sheet.positions) p = Vec3f(Vec3d(p) + Vec3d{x, 0, 0});
    const Collider collider{.map = box, .pose = {{}, {x, 0, 0}}, .linear_velocity = {box_speed, 0, 0}};
    Simulation simulation(sheet, {collider}, options);
    for (std::size_t i = 0; i < sheet.particle_count(); ++i)
        simulation.set_particle_velocity(i, {speed, 0, 0});
    const double from{simulation.positions()[12].x};
    for (int frame = 0; frame < 60; ++frame) simulation.step();
    return double{simulation.positions()[12].x} - from;
}

} // namespace

TEST(Newton, FrictionTakesAsMuchFarFromTheOriginAsAtIt) {
    const ExactMap box = ExactMap::build(make_box({12, 2, 1}));
    const double grip = 0.3 * kEarthGravity;
    for (const double x : {0.0, 20.0, 1000.0}) {
        const double stop = 2.0 * 2.0 / (2 * grip), start = 1 - 1 / (2 * grip);
        EXPECT_NEAR(slid_on_box(box, x, 2, 0), stop, 0.05 * stop) << x;
        EXPECT_NEAR(slid_on_box(box, x, 0, 1), start, 0.05 * start) << x;
    }
}

std::size_t inside_count(const Simulation& simulation) {
    std::size_t count = 0;
    for (const Collider& collider : simulation.colliders())
        for (const Vec3f& place : simulation.positions()) count += contains(collider, place) ? 1 : 0;
    return count;
}

TEST(Newton, ParticlesFallOnEveryKindOfMapAndStayOutside) {
    const TriangleMesh torus = make_torus(0.3, 0.12, 40, 20);
    SimulationOptions options = newton();
    options.thickness = 0.006;
    for (const ColliderMap& map :
         {ColliderMap(DistanceMap::build(torus)), ColliderMap(ExactMap::build(torus)),
          ColliderMap(std::make_shared<AnalyticBall>(0.3F, Vec3f{0, 0, -0.18F}))}) {
        Simulation simulation(sheet_at(0.15, 0.8, 17, {0.18, 0, 0}), {{.map = map}}, options);
        for (int i = 0; i < 120; ++i) {
            simulation.step();
            ASSERT_EQ(inside_count(simulation), 0u) << i;
        }
        EXPECT_GT(simulation.profile().contact_count, 1000u);
        EXPECT_GT(middle_of(simulation).z, -0.4); // of free fall: -19
        // Particles constraint where rays of the distance map touch the torus from aside.
        const bool is_ragged = std::holds_alternative<DistanceMap>(map.kind);
        EXPECT_LT(simulation.residual().root_mean_square, is_ragged ? 0.03 : 0.01);
        EXPECT_LT(simulation.residual().largest, is_ragged ? 0.4 : 0.06);
    }
}

TEST(Newton, ParticlesHoldByFrictionOnAMapThatMovesAndBearTheirWeight) {
    const Rotation tilt = Rotation::about({1, 0, 0}, 20 * std::numbers::pi / 180);
    const Deformable sheet = sheet_on_slope(tilt, 0.503);
    SimulationOptions options = newton();
    options.thickness = 0.004;
    options.friction = 0.5;
    Collider box{.map = DistanceMap::build(make_box({2, 2, 1}, 8)), .pose = {tilt, {}}};
    box.linear_velocity = {0.1, 0, 0.2};
    Simulation simulation(sheet, {box}, options);
    for (int i = 0; i < 60; ++i) simulation.step();
    const auto on_box = [&] { return simulation.colliders()[0].pose.to_local(middle_of(simulation)); };
    const Vec3d before = on_box();
    for (int i = 0; i < 60; ++i) simulation.step();
    EXPECT_LT(length(on_box() - before), 1e-4);
    const double weight = options.newton().material.density * 0.09 * kEarthGravity;
    EXPECT_NEAR(simulation.load_on(0).force.z / weight, -1, 0.02);
}

TEST(Newton, ParticlesThatBeginInsideAreNotThrownOut) {
    SimulationOptions options = newton();
    options.thickness = 0.006;
    options.gravity = {};
    const std::vector<Collider> ball{{.map = DistanceMap::build(make_sphere(0.3, 32, 16))}};
    Simulation simulation(sheet_at(0.28, 0.1, 5), ball, options);
    EXPECT_GT(inside_count(simulation), 20u);
    for (int i = 0; i < 10; ++i) {
        simulation.step();
        EXPECT_EQ(inside_count(simulation), 0u);
        EXPECT_LT(simulation.largest_speed(), 0.3); // 1.2 to come so far in a frame
    }
}

TEST(Newton, SurfacesCollideWithOneModelAndParticlesWithAnother) {
    const TriangleMesh plate = make_box({0.3, 0.3, 0.02});
    std::vector<Collider> colliders = colliders_of({plate});
    colliders[0].pose.translation = {0.25, 0, 0};
    colliders.push_back(
        {.map = DistanceMap::build(make_sphere(0.15, 32, 16)), .pose = {{}, {-0.25, 0, -0.14}}});
    Simulation simulation(sheet_at(0.02, 0.9, 19), colliders, newton_contact(0.006));
    for (int i = 0; i < 60; ++i) {
        simulation.step();
        ASSERT_EQ(meeting_faces(simulation, {plate}).size(), 0u) << i;
        ASSERT_EQ(inside_count(simulation), 0u) << i;
    }
    EXPECT_GT(middle_of(simulation).z, -0.4);
}

TEST(Newton, AThicknessOfZeroIsASmallOne) {
    for (const bool surfaces : {false, true}) {
        SimulationOptions options = newton_contact(0);
        if (!surfaces) options.newton().collision = CollisionMode::Particles;
        const TriangleMesh box = make_box({2, 2, 1});
        Simulation simulation(sheet_at(0.51, 0.4, 9), colliders_of({box}), options);
        for (int i = 0; i < 60; ++i) {
            simulation.step();
            ASSERT_EQ(inside_count(simulation), 0u);
            if (surfaces) {
                ASSERT_EQ(meeting_faces(simulation, {box}).size(), 0u);
            }
        }
        EXPECT_GT(middle_of(simulation).z, 0.5);
        EXPECT_LT(middle_of(simulation).z, 0.501 + 1e-6); // a fiftieth of the spacing is 0.001
    }
}

} // namespace
} // namespace echinus::test
