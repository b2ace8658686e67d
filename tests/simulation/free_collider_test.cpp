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
    options.surface_collision = true;
    options.thickness = 0.01;
    return options;
}

SimulationOptions without_forces() {
    SimulationOptions options = beside_free_models();
    options.gravity = {};
    options.air_drag = 0;
    return options;
}

TriangleMesh moved_by(TriangleMesh mesh, const Vec3f& by) {
    for (Vec3f& v : mesh.vertices) v = v + by;
    return mesh;
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
    EXPECT_NEAR(place.x, 2, 1e-9);
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

TEST(FreeCollider, ExchangesMomentumWithTheClothThatHitsIt) {
    // A sheet of 0.05 kg flies at 3 m/s at a ball of 0.2 kg.
    Collider ball{.map = ExactMap::build(make_sphere(0.2, 30, 15))};
    Simulation simulation(sheet_at(0.25, 0.5, 15, {0, 0, -3.0 / 60}), {ball}, without_forces());
    simulation.set_collider_free(0, 0.2);
    for (int i = 0; i < 60; ++i) simulation.step();
    double cloth = 0;
    const Deformable& d = simulation.deformable();
    double area = 0;
    for (const Triangle& face : d.faces) {
        const auto rest = [&](int k) { return Vec3d(d.rest_positions[face[static_cast<std::size_t>(k)]]); };
        const double share = length(cross(rest(1) - rest(0), rest(2) - rest(0))) / 6;
        area += 3 * share;
        for (const std::uint32_t i : face)
            cloth += 0.2 * share * double{d.positions[i].z - d.previous_positions[i].z} * 60;
    }
    EXPECT_NEAR(area, 0.25, 1e-6);
    const double body = 0.2 * simulation.colliders()[0].linear_velocity.z;
    EXPECT_LT(body, -0.05);
    EXPECT_NEAR(cloth + body, -3 * 0.05, 0.02 * 3 * 0.05);
}

TEST(FreeCollider, ComesToRestInAClothThatBearsIt) {
    Deformable trampoline = sheet_at(0, 2, 20);
    for (std::uint32_t i = 0; i < 20; ++i)
        for (const std::uint32_t pin : {i, 19 * 20 + i, 20 * i, 20 * i + 19})
            trampoline.inverse_masses[pin] = 0;
    const TriangleMesh ball = make_sphere(0.3, 40, 20);
    SimulationOptions options = beside_free_models();
    options.air_drag = 2;
    Simulation simulation(trampoline, {{.map = ExactMap::build(ball), .pose = {{}, {0, 0, 0.5}}}}, options);
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
