#include "support/custom_maps.hpp"
#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/error.hpp>
#include <echinus/intersections.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

using namespace echinus;
using namespace echinus::test;

// A cloth on a map of the user's own.

namespace {

constexpr double kThickness = 0.01;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Does the simulation go through with it? All positions finite after some frames, or an orderly end.
void expect_no_harm(const Contact& answer) {
    Simulation simulation(test::sheet_at(0.2, 0.5, 9),
                          {{.map = std::make_shared<test::ConstantAnswer>(answer)}},
                          test::jakobsen({.thickness = kThickness}));
    try {
        for (int i = 0; i < 30; ++i) simulation.step();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Diverged);
        return;
    }
    for (const Vec3f& p : simulation.positions()) EXPECT_TRUE(is_finite(p));
}

} // namespace

TEST(CustomMapSimulation, PushesOutOfABallThatMovesAndTurns) {
    const Collider ball{.map = std::make_shared<test::AnalyticBall>(1.0F),
                        .linear_velocity = {0, 0, 0.5},
                        .angular_velocity = {0.3, 0.1, 0.5}};
    Simulation simulation(test::sheet_at(1.02, 1, 15), {ball}, test::jakobsen({.thickness = kThickness}));
    for (int i = 0; i < 240; ++i) simulation.step();
    const Vec3f centre(simulation.colliders()[0].pose.translation);
    EXPECT_NEAR(centre.z, 0.5, 1e-6);
    float height = 0;
    for (const Vec3f& p : simulation.positions()) {
        EXPECT_GT(length(p - centre), 0.99F);
        height = std::max(height, p.z);
    }
    EXPECT_GT(height, 1.4F);
}

TEST(CustomMapSimulation, ComesToNoHarmByAnswersThatMakeNoSense) {
    for (const bool inside : {false, true}) {
        expect_no_harm({.point = {kNaN, 0, 0}, .normal = {0, 0, 1}, .depth = 1, .inside = inside});
        expect_no_harm({.point = {}, .normal = {0, kNaN, 1}, .depth = 1, .inside = inside});
        expect_no_harm({.point = {}, .normal = {0, 0, 1}, .depth = kNaN, .inside = inside});
        expect_no_harm({.point = {}, .normal = {0, 0, 1e30F}, .depth = 1, .inside = inside});
        expect_no_harm({.point = {}, .normal = {0, 0, 1e-30F}, .depth = -1, .inside = inside});
        expect_no_harm({.point = {1e30F, 0, 0}, .normal = {0, 0, 1}, .depth = 1e30F, .inside = inside});
        expect_no_harm({.point = {}, .normal = {}, .inside = inside});
    }
}

TEST(CustomMapSimulation, LeavesAParticleInsideAloneThatItKnowsNoWayOutFor) {
    // As if there were no collider.
    const auto fallen = [](std::vector<Collider> colliders) {
        Simulation simulation(test::sheet_at(0, 0.5, 5), std::move(colliders),
                              test::jakobsen({.thickness = kThickness}));
        for (int i = 0; i < 20; ++i) simulation.step();
        return simulation.state_hash();
    };
    const Collider no_way_out{.map = std::make_shared<test::StuckInside>()};
    EXPECT_EQ(fallen({no_way_out}), fallen({}));
}

TEST(CustomMapSimulation, RefusesANullPointer) {
    test::expect_error(ErrorCode::InvalidOptions, "collider 0", [] {
        Simulation(test::sheet_at(0, 1, 5), {{.map = std::shared_ptr<const CustomMap>()}}, test::jakobsen());
    });
}

// Colliders that each move on their own, and those that are too far away to matter.

namespace {

SimulationOptions with_surfaces(bool self) {
    return {.solver =
                NewtonOptions{.collision = self ? CollisionMode::SurfacesAndSelf : CollisionMode::Surfaces},
            .thickness = 0.01};
}

/// Surfaces by the newton solver, particles by the paper's.
SimulationOptions surfaces_or_particles(bool surfaces) {
    return surfaces ? with_surfaces(true) : jakobsen({.thickness = 0.01});
}

} // namespace

TEST(SeveralColliders, KeepASheetOffAllOfThemWhileEachMovesOnItsOwn) {
    // A floor at rest, a ball that rises, a rod that sweeps across and turns, and a box that swings on keys.
    const std::vector<TriangleMesh> models{make_box({3, 3, 0.1}), make_sphere(0.2, 20, 10),
                                           make_box({0.05, 1.2, 0.05}, 4), make_box({0.2, 0.2, 0.2}, 2)};
    for (const bool self : {false, true}) {
        std::vector<Collider> colliders = colliders_of(models);
        colliders[0].pose.translation = {0, 0, -0.5};
        colliders[1].linear_velocity = {0, 0, 0.1};
        colliders[2].pose.translation = {-0.9, 0, -0.15};
        colliders[2].linear_velocity = {0.5, 0, 0};
        colliders[2].angular_velocity = {0, 0, 0.7};
        std::vector<PoseKey> keys;
        for (int i = 0; i < 12; ++i)
            keys.push_back(
                {0.2 * i, {Rotation::about({0, 1, 1}, 0.5 * i), {0.45, 0.3 * (i % 2), -0.3 + 0.05 * i}}});
        colliders[3].pose = pose_at(keys, 0);
        Simulation simulation(sheet_at(0.25, 1.4, 17), colliders, with_surfaces(self));
        simulation.set_collider_keyframes(3, keys);
        expect_nothing_meets(simulation, models, 70);
        EXPECT_EQ(simulation.profile().lost_count, 0u);
    }
}

TEST(SeveralColliders, ChangeNothingWhileTheyAreFarAway) {
    const std::vector<TriangleMesh> ball{make_sphere(0.4, 24, 12)};
    for (const bool surface : {false, true}) {
        const SimulationOptions options = surfaces_or_particles(surface);
        std::vector<Collider> colliders = colliders_of({ball[0], make_box({1, 1, 1}), make_sphere(1, 16, 8)});
        colliders[1].pose.translation = {9, 0, 0};
        colliders[1].angular_velocity = {0, 0, 5};
        colliders[2].pose.translation = {0, 0, 8};
        Simulation among(sheet_at(0.45, 1, 20), colliders, options);
        Simulation alone(sheet_at(0.45, 1, 20), {colliders[0]}, options);
        for (int i = 0; i < (surface ? 40 : 150); ++i) {
            among.step();
            alone.step();
            ASSERT_EQ(among.state_hash(), alone.state_hash()) << i;
        }
    }
}

TEST(SeveralColliders, AreMetHoweverFastTheyCome) {
    // Within a frame: a sheet that is shot at a far box, and a box that is led into a sheet from far away.
    const std::vector<TriangleMesh> models{make_box({0.1, 0.1, 0.1}), make_box({2, 2, 0.05}, 4)};
    for (const bool surface : {false, true})
        for (const bool sheet_comes : {false, true}) {
            const SimulationOptions options = surfaces_or_particles(surface);
            std::vector<Collider> colliders = colliders_of(models);
            colliders[0].pose.translation = {0, 0, 40};
            colliders[1].pose.translation = {0, 0, -10};
            Simulation simulation(sheet_at(0, 0.5, 10), colliders, options);
            for (int i = 0; i < 5; ++i) simulation.step();
            if (sheet_comes)
                for (std::size_t i = 0; i < 100; ++i) simulation.set_particle_velocity(i, {0, 0, -1000});
            else
                simulation.set_collider_pose(1, {{}, {0, 0, 10}});
            for (int i = 0; i < 8; ++i) {
                simulation.step();
                ASSERT_TRUE(!surface || meeting_faces(simulation, models).empty()) << i;
                for (const Vec3f& p : simulation.positions())
                    ASSERT_GT(double{p.z}, simulation.colliders()[1].pose.translation.z) << i;
            }
            EXPECT_EQ(simulation.profile().lost_count, 0u);
            EXPECT_EQ(simulation.profile().unresolved_count, 0u);
        }
}

TEST(SeveralColliders, ComeAndGo) {
    // A ball that passes over a sheet again and again, far away in between, and pushes it down; another that
    // stays below its other half, so that there is room between them.
    const std::vector<TriangleMesh> models{make_sphere(0.25, 20, 10), make_sphere(0.15, 20, 10)};
    std::vector<Collider> colliders = colliders_of(models);
    std::vector<PoseKey> keys;
    for (int i = 0; i < 5; ++i) keys.push_back({0.9 * i, {{}, {i % 2 == 0 ? -2.5 : 2.5, 0.2, 0.41}}});
    colliders[0].pose.translation = {0, -0.25, 0};
    colliders[1].pose = pose_at(keys, 0);
    Deformable sheet = sheet_at(0.27, 1, 20);
    for (const std::size_t corner : {0u, 19u, 380u, 399u}) sheet.inverse_masses[corner] = 0;
    Simulation simulation(sheet, colliders, with_surfaces(true));
    simulation.set_collider_keyframes(1, keys);
    expect_nothing_meets(simulation, models, 120);
}

// Pairs of particles and colliders that do not collide (Deformable::filters).

namespace {

const TriangleMesh kTable = make_box({4, 2, 0.2}, 3), kFloor = make_box({6, 4, 0.2}, 3);

/// The table's top is at 0, the floor's at -0.5.
std::vector<Collider> table_and_floor(bool distance_maps) {
    std::vector<Collider> colliders = colliders_of({kTable, kFloor});
    if (distance_maps) {
        colliders[0].map = DistanceMap::build(kTable, {});
        colliders[1].map = DistanceMap::build(kFloor, {});
    }
    colliders[0].pose.translation = {0, 0, -0.1};
    colliders[1].pose.translation = {0, 0, -0.6};
    return colliders;
}

Deformable moved(Deformable sheet, const Vec3f& by) {
    for (Vec3f& p : sheet.positions) p = p + by;
    return sheet;
}

/// The first sheet passes through the table, in which it begins to be, and the other does not.
Deformable two_sheets() {
    const Deformable sheet = sheet_at(0, 0.6, 9);
    const std::vector<Deformable> sheets{passing_through(0, moved(sheet, {-1, 0, -0.05F})),
                                         moved(sheet, {1, 0, 0.1F})};
    return combine(sheets);
}

std::size_t pairs_with(const Simulation& simulation, std::span<const Triangle> faces, TriangleMesh model,
                       std::size_t collider) {
    for (Vec3f& p : model.vertices) p = Vec3f(simulation.colliders()[collider].pose.to_world(Vec3d(p)));
    const TriangleMesh part{{simulation.positions().begin(), simulation.positions().end()},
                            {faces.begin(), faces.end()}};
    return intersecting_pairs(part, model).size();
}

float highest(std::span<const Vec3f> positions) {
    float highest = positions[0].z;
    for (const Vec3f& p : positions) highest = std::max(highest, p.z);
    return highest;
}

} // namespace

TEST(CollisionFilter, LetsOnePartOfADeformableThroughAModelThatHoldsTheOther) {
    for (const bool surfaces : {true, false})
        for (const bool distance_maps : {false, true}) {
            if (surfaces && distance_maps) continue;
            SCOPED_TRACE(surfaces ? "surfaces" : distance_maps ? "distance maps" : "exact maps");
            const Deformable both = two_sheets();
            const std::size_t count = both.particle_count() / 2, face_count = both.faces.size() / 2;
            Simulation simulation(both, table_and_floor(distance_maps), surfaces_or_particles(surfaces));
            const std::span<const Triangle> faces(both.faces);
            for (int frame = 0; frame < (surfaces ? 80 : 200); ++frame) {
                simulation.step();
                if (!surfaces) continue;
                ASSERT_EQ(pairs_with(simulation, faces.subspan(face_count), kTable, 0), 0U) << frame;
                ASSERT_EQ(pairs_with(simulation, faces, kFloor, 1), 0U) << frame;
            }
            EXPECT_LT(highest(simulation.positions().first(count)), -0.45F);
            EXPECT_GT(highest(simulation.positions().first(count)), -0.5F);
            EXPECT_NEAR(highest(simulation.positions().subspan(count)), 0.01F, 0.005F);
            EXPECT_EQ(simulation.profile().lost_count, 0U);
            EXPECT_EQ(simulation.profile().unresolved_count, 0U);
        }
}

TEST(CollisionFilter, LeavesEveryBitAsIfTheModelWereNotThere) {
    // A ball that holds the sheet, and a box that moves through it and turns.
    for (const bool surfaces : {true, false}) {
        const SimulationOptions options = surfaces_or_particles(surfaces);
        std::vector<Collider> colliders = colliders_of({make_sphere(0.4, 24, 12), make_box({0.3, 0.3, 0.3})});
        colliders[1].pose.translation = {0.5, 0, 0.6};
        colliders[1].linear_velocity = {-0.5, 0, -0.3};
        colliders[1].angular_velocity = {1, 2, 3};
        Simulation through(passing_through(1, sheet_at(0.45, 1, 20)), colliders, options);
        Simulation without(sheet_at(0.45, 1, 20), {colliders[0]}, options);
        for (int frame = 0; frame < (surfaces ? 40 : 150); ++frame) {
            through.step();
            without.step();
            ASSERT_EQ(through.state_hash(), without.state_hash()) << frame;
        }
        EXPECT_GT(through.profile().contact_count, 0U);
    }
}

TEST(CollisionFilter, LetsFacesThroughThatHaveAParticleWhichPasses) {
    // The first column passes: it falls through the table, and swings from the second, which does not.
    Deformable sheet = sheet_at(0.05, 1, 11);
    for (std::uint32_t row = 0; row < 11; ++row) sheet.filters.push_back({11 * row, 0});
    Simulation simulation(sheet, table_and_floor(false),
                          {.solver = NewtonOptions{.collision = CollisionMode::Surfaces}, .thickness = 0.01});
    for (int frame = 0; frame < 40; ++frame) simulation.step();
    for (std::uint32_t particle = 0; particle < sheet.particle_count(); ++particle) {
        const bool passes = particle % 11 == 0;
        EXPECT_EQ(simulation.positions()[particle].z < 0, passes) << particle;
    }
    EXPECT_EQ(simulation.profile().unresolved_count, 0U);
}

TEST(CollisionFilter, LetsWhatUntanglesStayInAModelThatItPassesThrough) {
    SimulationOptions options{.solver = NewtonOptions{.collision = CollisionMode::Surfaces, .untangle = true},
                              .thickness = 0.01};
    const Deformable begins_in_both = passing_through(0, sheet_at(-0.499999, 0.6, 9));
    std::vector<Collider> colliders = table_and_floor(false);
    colliders[0].pose.translation = {0, 0, -0.5};
    const Simulation simulation(begins_in_both, colliders, options);
    for (std::size_t i = 0; i < begins_in_both.particle_count(); ++i)
        EXPECT_GT(simulation.positions()[i].z, -0.499F);
    EXPECT_EQ(pairs_with(simulation, begins_in_both.faces, kFloor, 1), 0U);
}

TEST(CollisionFilter, IsRefusedWhereItNamesWhatIsNotThere) {
    const auto expect_words = [](const char* words, const CollisionFilter& filter) {
        Deformable sheet = sheet_at(0.1, 1, 3);
        sheet.filters.push_back(filter);
        expect_error(ErrorCode::InvalidOptions, words,
                     [&] { Simulation(sheet, table_and_floor(false), jakobsen()); });
    };
    expect_words("filter 0 of particle 9: the last particle is 8", {9, 0});
    expect_words("filter 0 of particle 1 refers to collider 2 of 2, numbered from 0", {1, 2});
    Deformable sheet = sheet_at(0.1, 1, 3);
    sheet.filters.push_back({9, 0});
    expect_error(ErrorCode::InvalidOptions, "a filter refers to particle 9", [&] {
        combine(std::vector{sheet, sheet});
    });
}
