#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

using namespace echinus;
using namespace echinus::test;

namespace {

SimulationOptions beside_free_models() {
    SimulationOptions options;
    options.newton().collision = CollisionMode::Surfaces;
    options.thickness = 0.01;
    return options;
}

SimulationOptions without_forces() {
    SimulationOptions options = beside_free_models();
    options.gravity = {};
    options.newton().air_drag = 0;
    return options;
}

TriangleMesh moved_by(TriangleMesh mesh, const Vec3f& by) {
    for (Vec3f& v : mesh.vertices) v = v + by;
    return mesh;
}

/// A cloth that is held along its border.
Deformable trampoline() {
    Deformable sheet = sheet_at(0, 2, 20);
    for (std::uint32_t i = 0; i < 20; ++i)
        for (const std::uint32_t pin : {i, 19 * 20 + i, 20 * i, 20 * i + 19}) sheet.inverse_masses[pin] = 0;
    return sheet;
}

std::string refusal(const ColliderMap& map, double mass, SimulationOptions options = {}) {
    Simulation simulation(sheet_at(5, 1, 3), {{.map = map}}, options);
    return refusal_of(ErrorCode::InvalidOptions, [&] { simulation.set_collider_free(0, mass); });
}

} // namespace

TEST(FreeCollider, FallsAndFliesAsABodyDoes) {
    Collider ball{.map = ExactMap::build(make_sphere(0.1, 20, 10)), .linear_velocity = {2, 0, 3}};
    Simulation simulation(sheet_at(-50, 1, 3), {ball}, beside_free_models());
    simulation.set_collider_free(0, 0.5);
    for (int i = 0; i < 60; ++i) simulation.step();
    const Vec3d place = simulation.colliders()[0].pose.translation;
    EXPECT_NEAR(place.x, 2, 1e-7);                 // the linear systems are in floats
    EXPECT_NEAR(place.z, 3 - 9.81 / 2, 9.81 / 60); // the error of a step of first order
}

TEST(FreeCollider, TurnsAboutItsCentreOfMassWhereverItsOriginIs) {
    const Vec3f off{0.3F, 0, 0};
    Collider box{.map = ExactMap::build(moved_by(make_box({0.4, 0.2, 0.1}), off)),
                 .angular_velocity = {0, 0, 3}};
    box.linear_velocity = {0, -0.9, 0}; // so that its centre rests
    Simulation simulation(sheet_at(50, 1, 3), {box}, without_forces());
    simulation.set_collider_free(0, 2);
    for (int i = 0; i < 60; ++i) {
        simulation.step();
        EXPECT_LT(length(simulation.colliders()[0].pose.to_world(Vec3d(off)) - Vec3d(off)), 1e-6);
    }
    const Vec3d x = simulation.colliders()[0].pose.rotation.apply({1, 0, 0});
    EXPECT_NEAR(std::atan2(x.y, x.x), 3, 1e-6);
}

TEST(FreeCollider, KeepsItsAngularMomentumAsItTumbles) {
    // About the axis of its middle moment a box turns over, and over again.
    Collider box{.map = ExactMap::build(make_box({0.4, 0.2, 0.1})), .angular_velocity = {0.05, 6, 0}};
    SimulationOptions options = without_forces();
    options.time_step = 1.0 / 240;
    Simulation simulation(sheet_at(50, 1, 3), {box}, options);
    simulation.set_collider_free(0, 3);
    const auto momentum = [&] {
        const Collider& now = simulation.colliders()[0];
        const Vec3d spin = now.pose.rotation.inverse().apply(now.angular_velocity);
        return now.pose.rotation.apply({spin.x * 3 / 12 * (0.04 + 0.01), spin.y * 3 / 12 * (0.16 + 0.01),
                                        spin.z * 3 / 12 * (0.16 + 0.04)});
    };
    const Vec3d before{0.05 * 0.25 * 0.05, 6 * 0.25 * 0.17, 0};
    bool has_turned_over = false;
    for (int i = 0; i < 1200; ++i) {
        simulation.step();
        EXPECT_LT(length(momentum() - before), 0.05 * length(before)) << i;
        has_turned_over = has_turned_over || simulation.colliders()[0].pose.rotation.apply({0, 1, 0}).y < 0;
    }
    EXPECT_TRUE(has_turned_over);
}

TEST(FreeCollider, KeepsItsEnergyAsALongRodTumbles) {
    const Vec3d size{0.8, 0.01, 0.01};
    Collider rod{.map = ExactMap::build(make_box(size)), .angular_velocity = {8, 3, 5}};
    Simulation simulation(sheet_at(50, 1, 3), {rod}, without_forces());
    simulation.set_collider_free(0, 12);
    const auto energy = [&] {
        const Collider& now = simulation.colliders()[0];
        const Vec3d spin = now.pose.rotation.inverse().apply(now.angular_velocity);
        const Vec3d sq{size.x * size.x, size.y * size.y, size.z * size.z};
        return (spin.x * spin.x * (sq.y + sq.z) + spin.y * spin.y * (sq.x + sq.z) +
                spin.z * spin.z * (sq.x + sq.y)) /
               2;
    };
    simulation.step();
    const double before = energy();
    for (int i = 0; i < 300; ++i) {
        simulation.step();
        ASSERT_NEAR(energy(), before, 0.02 * before) << i;
    }
}

TEST(FreeCollider, ChangesNothingFarAwayHoweverHeavyItIs) {
    Deformable sheet = sheet_at(0, 1, 21);
    for (std::uint32_t i = 0; i < 21; ++i)
        for (const std::uint32_t pin : {i, 20 * 21 + i, 21 * i, 21 * i + 20}) sheet.inverse_masses[pin] = 0;
    const auto fall = [&](double far_mass) {
        Collider ball{.map = ExactMap::build(make_sphere(0.12, 32, 16)), .pose = {{}, {0, 0, 0.2}}};
        Collider far = ball;
        far.pose.translation = {50, 0, 0};
        Simulation simulation(sheet, {ball, far}, beside_free_models());
        simulation.set_collider_free(0, 0.02);
        simulation.set_collider_free(1, far_mass);
        for (int i = 0; i < 40; ++i) simulation.step();
        return simulation.colliders()[0].pose.translation.z;
    };
    EXPECT_NEAR(fall(1e4), fall(0.01), 0.002);
}

TEST(FreeCollider, FallsFromCloseToClothThatIsCloseToATable) {
    SimulationOptions options = beside_free_models();
    options.thickness = 0.001;
    options.time_step = 1.0 / 30;
    Simulation simulation(sheet_at(0.006, 1, 31),
                          {{.map = ExactMap::build(make_box({0.1, 0.1, 0.1})), .pose = {{}, {0, 0, 0.059}}},
                           {.map = ExactMap::build(make_box({4, 4, 0.1})), .pose = {{}, {0, 0, -0.05}}}},
                          options);
    simulation.set_collider_free(0, 1);
    for (int i = 0; i < 30; ++i) simulation.step();
    EXPECT_NEAR(simulation.colliders()[0].pose.translation.z, 0.052, 0.001);
}

TEST(FreeCollider, ExchangesMomentumWithTheClothThatHitsIt) {
    // A sheet of 0.05 kg flies at 3 m/s at a ball of 0.2 kg, beside its centre.
    constexpr double kRadius = 0.2, kMass = 0.2, kDensity = 0.2;
    Collider ball{.map = ExactMap::build(make_sphere(kRadius, 30, 15)), .pose = {{}, {0.1, 0, 0}}};
    SimulationOptions options = without_forces();
    options.time_step = 1.0 / 240; // an angular momentum is kept the better the shorter the step
    Simulation simulation(sheet_at(0.25, 0.5, 15, {0, 0, -3}), {ball}, options);
    simulation.set_collider_free(0, kMass);
    struct Momentum {
        Vec3d linear, angular; ///< about the origin
    };
    const auto momentum_of_cloth = [&] {
        Momentum sum;
        const Deformable& d = simulation.deformable();
        for (const Triangle& face : d.faces) {
            const auto rest = [&](int k) {
                return Vec3d(d.rest_positions[face[static_cast<std::size_t>(k)]]);
            };
            const double mass = kDensity * length(cross(rest(1) - rest(0), rest(2) - rest(0))) / 6;
            for (const std::uint32_t i : face) {
                const Vec3d place(d.positions[i]);
                const Vec3d own = Vec3d(d.velocities[i]) * mass;
                sum.linear += own;
                sum.angular += cross(place, own);
            }
        }
        return sum;
    };
    const Momentum before = momentum_of_cloth();
    EXPECT_NEAR(before.linear.z, -3 * 0.05, 1e-5);
    for (int i = 0; i < 120; ++i) simulation.step();
    const Momentum cloth = momentum_of_cloth();
    const Collider& now = simulation.colliders()[0];
    const Vec3d body = now.linear_velocity * kMass;
    EXPECT_LT(body.z, -0.05);
    EXPECT_LT(length(cloth.linear + body - before.linear), 0.001 * length(before.linear));
    const Vec3d spin = now.angular_velocity * (0.4 * kMass * kRadius * kRadius);
    const Vec3d of_body = cross(now.pose.translation, body) + spin;
    EXPECT_GT(length(of_body), 0.005); // the sheet hits it with 3 m/s * 0.05 kg * 0.1 m
    EXPECT_LT(length(cloth.angular + of_body), 0.001);
}

TEST(FreeCollider, ComesToRestOnClothThatLiesOnATableWhateverItWeighs) {
    const TriangleMesh ball = make_sphere(0.12, 32, 16), table = make_box({4, 4, 0.1});
    for (const double mass : {0.001, 1.0, 50.0}) {
        SimulationOptions options = beside_free_models();
        options.thickness = 0.005;
        Simulation simulation(sheet_at(0.1, 1, 21),
                              {{.map = ExactMap::build(ball), .pose = {{}, {0.05, 0.02, 0.45}}},
                               {.map = ExactMap::build(table), .pose = {{}, {0, 0, -0.05}}}},
                              options);
        simulation.set_collider_free(0, mass);
        for (int i = 0; i < 120; ++i) {
            simulation.step();
            ASSERT_EQ(meeting_faces(simulation, {ball, table}).size(), 0u) << mass << " kg, frame " << i;
            ASSERT_LT(simulation.largest_speed(), 3) << mass << " kg, frame " << i;
        }
        EXPECT_NEAR(simulation.colliders()[0].pose.translation.z, 0.12, 0.01) << mass;
        EXPECT_LT(length(simulation.colliders()[0].linear_velocity), 0.1) << mass;
    }
}

TEST(FreeCollider, StopsAtClothOfWhichEveryParticleIsHeld) {
    Deformable sheet = sheet_at(0, 1, 11);
    sheet.inverse_masses.assign(sheet.inverse_masses.size(), 0);
    const TriangleMesh ball = make_sphere(0.12, 32, 16);
    for (const double speed : {0.0, 30.0}) {
        Simulation simulation(sheet,
                              {{.map = ExactMap::build(ball),
                                .pose = {{}, {0.05, 0.02, 0.3}},
                                .linear_velocity = {0, 0, -speed}}},
                              beside_free_models());
        simulation.set_collider_free(0, 1);
        for (int i = 0; i < 60; ++i) {
            simulation.step();
            ASSERT_EQ(meeting_faces(simulation, {ball}).size(), 0u) << speed << " m/s, frame " << i;
        }
        EXPECT_NEAR(simulation.colliders()[0].pose.translation.z, 0.12, 0.02) << speed;
    }
}

TEST(FreeCollider, RestsOnClothOfWhichOnlyTheParticlesCollide) {
    SimulationOptions options;
    options.thickness = 0.01;
    options.newton().collision = CollisionMode::Particles;
    Simulation simulation(sheet_at(0.1, 1, 21),
                          {{.map = ExactMap::build(make_sphere(0.12, 32, 16)), .pose = {{}, {0, 0, 0.45}}},
                           {.map = ExactMap::build(make_box({4, 4, 0.1})), .pose = {{}, {0, 0, -0.05}}}},
                          options);
    simulation.set_collider_free(0, 1);
    for (int i = 0; i < 90; ++i) simulation.step();
    EXPECT_NEAR(simulation.colliders()[0].pose.translation.z, 0.12, 0.02);
    EXPECT_LT(simulation.largest_speed(), 0.3); // a ball of flat faces rocks
}

TEST(FreeCollider, ComesToRestInAClothThatBearsIt) {
    const TriangleMesh ball = make_sphere(0.3, 40, 20);
    SimulationOptions options = beside_free_models();
    options.newton().air_drag = 2;
    Simulation simulation(trampoline(), {{.map = ExactMap::build(ball), .pose = {{}, {0, 0, 0.5}}}}, options);
    simulation.set_collider_free(0, 0.3);
    double force = 0;
    for (int i = 0; i < 420; ++i) {
        simulation.step();
        ASSERT_EQ(meeting_faces(simulation, {ball}).size(), 0u) << i;
        if (i >= 360) force += simulation.load_on(0).force.z / 60;
    }
    EXPECT_NEAR(force, 0.3 * 9.81, 0.05 * 0.3 * 9.81);
    EXPECT_LT(simulation.colliders()[0].pose.translation.z, 0.3);
}

TEST(FreeCollider, ComesToRestWhereAHostHandsItsVelocitiesOverInEachFrame) {
    // From this height a ball bounced ever higher where the host moved it by the load of the frame before.
    Simulation simulation(trampoline(),
                          {{.map = ExactMap::build(make_sphere(0.3, 40, 20)), .pose = {{}, {0, 0, 0.85}}}},
                          beside_free_models());
    Vec3d velocity, angular_velocity;
    double force = 0;
    for (int i = 0; i < 300; ++i) {
        simulation.set_collider_velocity(0, velocity, angular_velocity);
        simulation.set_collider_free(0, 0.3);
        simulation.step();
        velocity = simulation.colliders()[0].linear_velocity;
        angular_velocity = simulation.colliders()[0].angular_velocity;
        if (i >= 240) force += simulation.load_on(0).force.z / 60;
    }
    EXPECT_NEAR(force, 0.3 * 9.81, 0.02 * 0.3 * 9.81);
    EXPECT_LT(simulation.colliders()[0].pose.translation.z, 0.3);
}

TEST(FreeCollider, NamesWhyItCannotBeFree) {
    const ColliderMap box = ExactMap::build(make_box({1, 1, 1}));
    EXPECT_EQ(refusal(box, 1), "");
    expect_words(refusal(box, 0), "collider 0 has a mass of 0");
    expect_words(refusal(box, std::nan("")), "mass");
    expect_words(refusal(DistanceMap::build(make_sphere(1, 20, 10)), 1), "no exact map");
    TriangleMesh open = make_box({1, 1, 1});
    open.faces.pop_back();
    expect_words(refusal(ExactMap::build(open), 1, beside_free_models()), "has to be closed");
    expect_words(refusal(box, 1, jakobsen()), "newton");
}
