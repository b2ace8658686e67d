// Pairs of particles and colliders that do not collide (Deformable::filters).

#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/intersections.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

using namespace echinus;
using namespace echinus::test;

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
    for (Vec3f& p : sheet.previous_positions) p = p + by;
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
            Simulation simulation(
                both, table_and_floor(distance_maps),
                {.thickness = 0.01, .surface_collision = surfaces, .self_collision = surfaces});
            const std::span<const Triangle> faces(both.faces);
            for (int frame = 0; frame < 200; ++frame) {
                simulation.step();
                if (!surfaces) continue;
                ASSERT_EQ(pairs_with(simulation, faces.subspan(face_count), kTable, 0), 0U) << frame;
                ASSERT_EQ(pairs_with(simulation, faces, kFloor, 1), 0U) << frame;
            }
            EXPECT_LT(highest(simulation.positions().first(count)), -0.45F);
            EXPECT_GT(highest(simulation.positions().first(count)), -0.5F);
            EXPECT_NEAR(highest(simulation.positions().subspan(count)), 0.01F, 0.005F);
            EXPECT_EQ(simulation.profile().lost_count, 0U);
            EXPECT_EQ(simulation.profile().squeezed_count, 0U);
        }
}

TEST(CollisionFilter, LeavesEveryBitAsIfTheModelWereNotThere) {
    // A ball that holds the sheet, and a box that moves through it and turns.
    for (const bool surfaces : {true, false}) {
        const SimulationOptions options{
            .thickness = 0.01, .surface_collision = surfaces, .self_collision = surfaces};
        std::vector<Collider> colliders = colliders_of({make_sphere(0.4, 24, 12), make_box({0.3, 0.3, 0.3})});
        colliders[1].pose.translation = {0.5, 0, 0.6};
        colliders[1].linear_velocity = {-0.5, 0, -0.3};
        colliders[1].angular_velocity = {1, 2, 3};
        Simulation through(passing_through(1, sheet_at(0.45, 1, 20)), colliders, options);
        Simulation without(sheet_at(0.45, 1, 20), {colliders[0]}, options);
        for (int frame = 0; frame < 150; ++frame) {
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
    Simulation simulation(sheet, table_and_floor(false), {.thickness = 0.01, .surface_collision = true});
    for (int frame = 0; frame < 100; ++frame) simulation.step();
    for (std::uint32_t particle = 0; particle < sheet.particle_count(); ++particle) {
        const bool passes = particle % 11 == 0;
        EXPECT_EQ(simulation.positions()[particle].z < 0, passes) << particle;
    }
    EXPECT_EQ(simulation.profile().squeezed_count, 0U);
}

TEST(CollisionFilter, LetsWhatUntanglesStayInAModelThatItPassesThrough) {
    SimulationOptions options{.thickness = 0.01, .surface_collision = true, .untangle = true};
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
                     [&] { Simulation(sheet, table_and_floor(false), {}); });
    };
    expect_words("filter 0 of particle 9: the last particle is 8", {9, 0});
    expect_words("filter 0 of particle 1 names collider 2 of 2, numbered from 0", {1, 2});
    Deformable sheet = sheet_at(0.1, 1, 3);
    sheet.filters.push_back({9, 0});
    expect_error(ErrorCode::InvalidOptions, "a filter names particle 9", [&] {
        combine(std::vector{sheet, sheet});
    });
}
