// Cloth by the paper's method on colliders, whatever kind of map they have.

#include "support/custom_maps.hpp"
#include "support/draping.hpp"
#include "support/instruction_sets.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

using namespace echinus;

namespace {

constexpr double kClothThickness = 0.01;

struct MapKind {
    std::string_view name;
    ColliderMap (*map_of)(const TriangleMesh&);
    bool is_exact;

    friend std::ostream& operator<<(std::ostream& out, const MapKind& kind) { return out << kind.name; }
};

ColliderMap exact_map(const TriangleMesh& mesh) {
    return ExactMap::build(mesh);
}
ColliderMap distance_map(const TriangleMesh& mesh) {
    return DistanceMap::build(mesh, {.longitude_count = 128, .colatitude_count = 128});
}
/// An exact map that is asked as if it were the user's.
ColliderMap custom_map(const TriangleMesh& mesh) {
    return std::make_shared<test::AskedExactMap>(ExactMap::build(mesh));
}

const std::vector<MapKind> kMapKinds{
    {"Exact", exact_map, true}, {"Distance", distance_map, false}, {"Custom", custom_map, true}};

class Draping : public testing::TestWithParam<MapKind> {
  protected:
    static ColliderMap map_of(const TriangleMesh& mesh) { return GetParam().map_of(mesh); }
};

INSTANTIATE_TEST_SUITE_P(, Draping, testing::ValuesIn(kMapKinds),
                         [](const auto& instance) { return std::string(instance.param.name); });

ColliderMap analytic_unit_ball(const TriangleMesh&) {
    return std::make_shared<test::AnalyticBall>(1.0F);
}

class DrapingOnABall : public Draping {};

INSTANTIATE_TEST_SUITE_P(, DrapingOnABall,
                         testing::Values(MapKind{"Exact", exact_map, true},
                                         MapKind{"Distance", distance_map, false},
                                         MapKind{"Custom", analytic_unit_ball, false}),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// Mean position of all particles.
Vec3d middle(const Simulation& simulation) {
    Vec3d sum;
    for (const Vec3f& p : simulation.positions()) sum += Vec3d(p);
    return sum * (1.0 / double(simulation.positions().size()));
}

Deformable particle_at(const Vec3f& place) {
    return {.positions = {place}, .inverse_masses = {1}, .constraints = {}, .faces = {}};
}

/// A small sheet that lies on a box at its thickness.
Simulation sheet_on(const Collider& box) {
    return Simulation(test::sheet_at(0.5 + kClothThickness, 0.3, 7), {box},
                      test::jakobsen({.thickness = kClothThickness, .friction = 0.8}));
}

/// How far a corner of the sheet is from where it would be, had it been carried along as if glued.
double distance_from_carried(const Simulation& simulation, const Vec3f& corner) {
    const Vec3d expected = simulation.colliders()[0].pose.to_world(Vec3d(corner));
    return length(Vec3d(simulation.positions()[0]) - expected);
}

} // namespace

TEST_P(Draping, LaysASheetFlatOnABoxAtItsThickness) {
    Simulation simulation(test::sheet_at(0.55, 0.5, 15), {{.map = map_of(make_box({1, 1, 1}))}},
                          test::jakobsen({.thickness = kClothThickness}));
    test::run_to_rest(simulation, 1000);
    // Between samples a distance map is off by the sagitta: 0.001 here.
    const double tolerance = GetParam().is_exact ? 1e-3 : 2e-3;
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(p.z, 0.5 + kClothThickness, tolerance);
    EXPECT_NEAR(middle(simulation).x, 0, 1e-3);
    EXPECT_NEAR(middle(simulation).y, 0, 1e-3);
}

TEST_P(DrapingOnABall, BringsASheetToRestOutside) {
    const TriangleMesh sphere = make_sphere(1, 80, 40);
    Simulation simulation(test::sheet_at(1.05, 2, 15), {{.map = map_of(sphere)}},
                          test::jakobsen({.thickness = kClothThickness, .friction = 0.8}));
    test::run_to_rest(simulation, 6000);
    test::expect_draped_over_unit_ball(simulation, kClothThickness);
    if (!GetParam().is_exact) return;
    for (const Vec3f& p : simulation.positions()) EXPECT_LT(winding_number(sphere, Vec3d(p)), 0.5);
}

TEST_P(Draping, HoldsASheetOnASlopeThatFrictionCanHoldAndNotOnASteeperOne) {
    // Coulomb: it rests where the slope's tangent is below the friction.
    const ColliderMap box = map_of(make_box({2, 2, 1}));
    EXPECT_LT(test::slid_down_slope(box, std::atan(0.4), test::jakobsen()), 0.005);
    EXPECT_GT(test::slid_down_slope(box, std::atan(0.6), test::jakobsen()), 0.05);
}

TEST_P(Draping, CarriesASheetAlongWithAMovingCollider) {
    Simulation simulation = sheet_on({.map = map_of(make_box({2, 2, 1})), .linear_velocity = {0.3, 0, 0}});
    for (int i = 0; i < 480; ++i) simulation.step();
    EXPECT_NEAR(simulation.colliders()[0].pose.translation.x, 0.6, 1e-9);
    EXPECT_NEAR(middle(simulation).x, 0.6, 0.03);
    EXPECT_NEAR(middle(simulation).y, 0, 1e-3);
}

TEST_P(Draping, TurnsASheetWithATurningColliderAndDoesNotFlingItOff) {
    Simulation simulation = sheet_on({.map = map_of(make_box({2, 2, 1})), .angular_velocity = {0, 0, 1}});
    const Vec3f corner = simulation.positions()[0];
    for (int i = 0; i < 240; ++i) simulation.step();
    EXPECT_NEAR(distance_from_carried(simulation, corner), 0, 0.02);
}

TEST_P(Draping, LiftsASheetOnARisingCollider) {
    Simulation simulation = sheet_on({.map = map_of(make_box({2, 2, 1})), .linear_velocity = {0, 0, 0.5}});
    for (int i = 0; i < 240; ++i) simulation.step();
    for (const Vec3f& p : simulation.positions()) EXPECT_NEAR(p.z, 1 + kClothThickness, 3e-3);
}

TEST_P(Draping, CarriesTurnsAndLiftsASheetAtOnce) {
    Simulation simulation = sheet_on({.map = map_of(make_box({2, 2, 1})),
                                      .linear_velocity = {0.2, 0, 0.3},
                                      .angular_velocity = {0, 0, 1}});
    const Vec3f corner = simulation.positions()[0];
    for (int i = 0; i < 240; ++i) simulation.step();
    EXPECT_NEAR(distance_from_carried(simulation, corner), 0, 0.02);
}

TEST_P(Draping, LetsAParticleOutThatBeganInside) {
    Simulation simulation(particle_at({0.1F, 0.05F, 0.8F}), {{.map = map_of(make_sphere(1, 80, 40))}},
                          test::jakobsen({.thickness = kClothThickness}));
    for (int i = 0; i < 60; ++i) simulation.step();
    EXPECT_GT(length(simulation.positions()[0]), 0.999);
}

TEST_P(Draping, LeavesPinnedParticlesAloneEvenInside) {
    Deformable particle = particle_at({0, 0, 0.5F});
    particle.inverse_masses = {0};
    Simulation simulation(particle, {{.map = map_of(make_sphere(1, 80, 40))}},
                          test::jakobsen({.thickness = kClothThickness}));
    for (int i = 0; i < 10; ++i) simulation.step();
    EXPECT_EQ(simulation.positions()[0], (Vec3f{0, 0, 0.5F}));
    EXPECT_EQ(simulation.profile().lost_count, 0u);
}

TEST_P(Draping, AsksEveryColliderAboutEveryParticleInEveryRelaxation) {
    const Collider box{.map = map_of(make_box({1, 1, 1}))};
    Simulation simulation(test::sheet_at(2, 0.5, 4), {box, box},
                          test::jakobsen({.solver = JakobsenOptions{.iteration_count = 7}}));
    simulation.step();
    EXPECT_EQ(simulation.profile().query_count, 16u * 2u * 7u);
    EXPECT_EQ(simulation.profile().contact_count, 0u);
}

TEST_P(Draping, GivesTheSameBitsOnEveryRunInEveryCopyAndUnderEachInstructionSet) {
    const ColliderMap torus = map_of(make_torus(1, 0.4, 30, 16));
    std::vector<std::uint64_t> hashes;
    test::under_each_instruction_set([&](std::string_view) {
        const Collider turning{
            .map = torus, .linear_velocity = {0, 0, 0.4}, .angular_velocity = {0.2, 0.1, 2}};
        const Collider still{.map = torus, .pose = {Rotation::about({1, 2, 3}, 1), {0.3, 0.2, -1}}};
        Simulation simulation(test::sheet_at(0.45, 2, 15), {turning, still},
                              test::jakobsen({.thickness = kClothThickness}));
        for (int i = 0; i < 30; ++i) simulation.step();
        Simulation copy = simulation;
        for (Simulation* each : {&simulation, &copy}) {
            for (int i = 0; i < 30; ++i) each->step();
            EXPECT_GT(each->profile().contact_count, 0u);
            hashes.push_back(each->state_hash());
        }
    });
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}
