#include "simulation/sticks.hpp"
#include "simulation/stretched_part.hpp"
#include "support/cloth_meshes.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

using namespace echinus;

namespace {

/// What joins two particles of a sheet, by how far apart they are in columns and rows; nothing otherwise.
bool should_join(int columns_apart, int rows_apart, StickKind kind) {
    const int far = std::max(columns_apart, rows_apart);
    const int near = std::min(columns_apart, rows_apart);
    switch (kind) {
    case StickKind::Structural:
        return far == 1 && near == 0;
    case StickKind::Shear:
        return far == 1 && near == 1;
    default:
        return far == 2 && near == 0;
    }
}

} // namespace

TEST(Cloth, HasEveryStickOfItsKindOnceAndNoOther) {
    for (const auto& [columns, rows] : {std::pair{2, 2}, {7, 4}, {3, 9}, {8, 8}}) {
        const Deformable cloth =
            make_cloth({.column_count = std::uint32_t(columns), .row_count = std::uint32_t(rows)});
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (const Stick& stick : cloth.sticks) {
            const int a = int(stick.a);
            const int b = int(stick.b);
            EXPECT_TRUE(should_join(std::abs(a % columns - b % columns), std::abs(a / columns - b / columns),
                                    stick.kind))
                << a << " " << b;
            EXPECT_TRUE(seen.insert(std::minmax(stick.a, stick.b)).second) << a << " " << b;
        }
        const int structural = (columns - 1) * rows + columns * (rows - 1);
        const int shear = 2 * (columns - 1) * (rows - 1);
        const int bending = (columns - 2) * rows + columns * (rows - 2);
        EXPECT_EQ(cloth.sticks.size(), std::size_t(structural + shear + bending));
    }
}

TEST(Cloth, OfThePaperHas59002Sticks) {
    EXPECT_EQ(make_cloth({.column_count = 100, .row_count = 100}).sticks.size(), 59'002u);
}

TEST(Cloth, IsAtRestWhereItStarts) {
    const RigidTransform pose{Rotation::about({1, 2, 3}, 0.8), {5, -4, 3}};
    const Deformable cloth =
        make_cloth({.column_count = 9, .row_count = 6, .width = 2, .height = 3, .pose = pose});
    EXPECT_EQ(cloth.positions, cloth.previous_positions);
    for (const Stick& stick : cloth.sticks)
        EXPECT_NEAR(length(cloth.positions[stick.b] - cloth.positions[stick.a]), stick.rest_length, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.front()) - pose.to_world({-1, -1.5, 0})), 0, 1e-6);
    EXPECT_NEAR(length(Vec3d(cloth.positions.back()) - pose.to_world({1, 1.5, 0})), 0, 1e-6);
}

TEST(Cloth, TurnsAllItsFacesAlongItsLocalZ) {
    const RigidTransform pose{Rotation::about({1, 0, 0}, std::numbers::pi / 2), {}};
    const Deformable cloth = make_cloth({.column_count = 5, .row_count = 4, .pose = pose});
    EXPECT_EQ(cloth.faces.size(), 4u * 3u * 2u);
    const Vec3d front = pose.rotation.apply({0, 0, 1});
    double area = 0;
    for (const Triangle& face : cloth.faces) {
        const Vec3d a(cloth.positions[face[0]]);
        const Vec3d twice_area =
            cross(Vec3d(cloth.positions[face[1]]) - a, Vec3d(cloth.positions[face[2]]) - a);
        EXPECT_NEAR(dot(twice_area, front), length(twice_area), 1e-7);
        area += length(twice_area) / 2;
    }
    EXPECT_NEAR(area, 1, 1e-6);
}

TEST(Cloth, PinsWhatItIsToldTo) {
    const Deformable cloth = make_cloth({.column_count = 3, .row_count = 3, .pins = {0, 8}});
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(cloth.inverse_masses[i], i == 0 || i == 8 ? 0 : 1);
}

TEST(Cloth, RefusesSizesThatMakeNoSheet) {
    const auto code_of = [](const ClothOptions& options) {
        try {
            make_cloth(options);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::Damaged;
    };
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(code_of({.column_count = 1}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of({.row_count = 0}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of({.column_count = 1U << 31, .row_count = 1U << 31}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of({.width = 0}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of({.height = kNaN}), ErrorCode::InvalidOptions);
    EXPECT_EQ(code_of({.column_count = 4, .row_count = 4, .pins = {16}}), ErrorCode::InvalidOptions);
}

namespace {

/// A sheet whose sticks are all off their length.
Deformable crumpled_cloth(std::uint32_t column_count, std::uint32_t row_count,
                          std::vector<std::uint32_t> pins = {}) {
    Deformable cloth =
        make_cloth({.column_count = column_count, .row_count = row_count, .pins = std::move(pins)});
    test::Random random(column_count * 100 + row_count);
    for (Vec3f& p : cloth.positions) p += test::in_cube(random, 0.1F);
    return cloth;
}

/// Three relaxations under each instruction set must give the same bits.
void expect_same_bits_under_each_instruction_set(const Deformable& cloth,
                                                 const SimulationOptions& options = {}) {
    std::vector<std::vector<Vec3f>> results, all_left_over;
    test::under_each_instruction_set([&](std::string_view) {
        StickArrays sticks = weighted_sticks(cloth, options);
        PointArrays positions, remainders;
        positions.load(cloth.positions);
        remainders.resize(cloth.particle_count());
        PointArrays* const kept = options.solver == SolverKind::Xpbd ? &remainders : nullptr;
        for (int i = 0; i < 3; ++i) relax(sticks, positions, kept);
        std::vector<Vec3f> result(cloth.particle_count()), left_over = result;
        positions.store(result);
        remainders.store(left_over);
        results.push_back(result);
        all_left_over.push_back(left_over);
    });
    for (const auto& result : results) EXPECT_EQ(result, results.front());
    for (const auto& left_over : all_left_over) EXPECT_EQ(left_over, all_left_over.front());
    EXPECT_NE(results.front(), cloth.positions);
}

std::size_t scattered_count(const StickArrays& sticks) {
    std::size_t count = 0;
    for (const StickRun& run : sticks.schedule.runs)
        count += run.shape == RunShape::Scattered ? run.count : 0;
    return count;
}

} // namespace

TEST(Sticks, RelaxToTheSameBitsUnderEachInstructionSetInSheetsOfAnySize) {
    for (std::uint32_t columns = 2; columns < 40; ++columns)
        expect_same_bits_under_each_instruction_set(crumpled_cloth(columns, 3 + columns % 4));
}

TEST(Sticks, RelaxToTheSameBitsUnderEachInstructionSetWithPinsAndUnequalMasses) {
    expect_same_bits_under_each_instruction_set(crumpled_cloth(37, 9, {0, 3, 40, 41, 300}));
    Deformable uneven = crumpled_cloth(20, 20);
    for (std::size_t i = 0; i < uneven.particle_count(); ++i)
        uneven.inverse_masses[i] = 1.0F / static_cast<float>(1 + i / 100);
    expect_same_bits_under_each_instruction_set(uneven);
}

TEST(Sticks, RelaxToTheSameBitsUnderEachInstructionSetInAnyOrder) {
    Deformable cloth = crumpled_cloth(17, 11);
    test::Random random(5);
    std::shuffle(cloth.sticks.begin(), cloth.sticks.end(), random);
    expect_same_bits_under_each_instruction_set(cloth);
}

TEST(Sticks, OfAMeshRelaxToTheSameBitsUnderEachInstructionSet) {
    const SimulationOptions springs{.solver = SolverKind::Xpbd, .compliance = {0, 1e-5, 1e-4}};
    for (std::uint32_t columns = 2; columns < 20; ++columns) {
        const TriangleMesh flat = test::sheet_mesh(columns, 9);
        const Deformable cloth =
            make_cloth(test::rumpled(flat, 0.1F), {.rest_vertices = flat.vertices, .pins = {3}});
        expect_same_bits_under_each_instruction_set(cloth);
        expect_same_bits_under_each_instruction_set(cloth, springs);
    }
}

TEST(Sticks, ThatGiveWayRelaxToTheSameBitsUnderEachInstructionSet) {
    const SimulationOptions springs{.solver = SolverKind::Xpbd, .compliance = {1e-6, 1e-5, 1e-4}};
    for (std::uint32_t columns = 2; columns < 40; ++columns)
        expect_same_bits_under_each_instruction_set(crumpled_cloth(columns, 4, {1}), springs);
    expect_same_bits_under_each_instruction_set(crumpled_cloth(600, 3), springs);
}

TEST(Sticks, StandInRunsThatFollowEachOtherAndShareNoParticle) {
    for (const Deformable& cloth :
         {crumpled_cloth(2, 2), crumpled_cloth(33, 7), crumpled_cloth(24, 24, {30}),
          make_cloth(make_torus(1, 0.4, 30, 20), {}), make_cloth(make_sphere(1, 100, 20), {})}) {
        const StickArrays sticks = weighted_sticks(cloth, {});
        std::size_t next = 0;
        for (const StickRun& run : sticks.schedule.runs) {
            EXPECT_EQ(run.first, next);
            next += run.count;
            if (run.shape == RunShape::Scattered) continue;
            std::set<std::uint32_t> particles;
            for (std::size_t i = run.first; i < next; ++i) {
                EXPECT_TRUE(particles.insert(sticks.a[i]).second);
                EXPECT_TRUE(particles.insert(sticks.b[i]).second);
                if (run.shape == RunShape::Disjoint) continue;
                EXPECT_EQ(sticks.share_a[i], run.share_a);
                EXPECT_EQ(sticks.share_b[i], run.share_b);
            }
        }
        EXPECT_EQ(next, sticks.count());
    }
}

TEST(Sticks, OfAClothStandInLongRuns) {
    EXPECT_EQ(scattered_count(weighted_sticks(crumpled_cloth(100, 20), {})), 0u);
}

TEST(Sticks, OfAMeshStandInRunsThatShareNoParticle) {
    const StickArrays torus = weighted_sticks(make_cloth(make_torus(1, 0.4, 60, 24), {}), {});
    EXPECT_LT(scattered_count(torus), torus.count() / 100);
    // At its poles a sphere has more sticks than there are groups.
    const StickArrays sphere = weighted_sticks(make_cloth(make_sphere(1, 100, 20), {}), {});
    EXPECT_LT(scattered_count(sphere), sphere.count() / 20);
}

TEST(Sticks, BetweenPinnedParticlesAreLeftOut) {
    const Deformable cloth = crumpled_cloth(6, 4, {0, 1});
    EXPECT_EQ(weighted_sticks(cloth, {}).count(), cloth.sticks.size() - 1);
}

TEST(StretchedPart, IsEmptyInAClothAtRest) {
    const Deformable cloth = make_cloth({.column_count = 40, .row_count = 40});
    const StickArrays sticks = weighted_sticks(cloth, {});
    PointArrays positions;
    positions.load(cloth.positions);
    StretchedPart part(sticks, cloth.particle_count());
    part.find(sticks, positions);
    EXPECT_TRUE(part.empty());
}

TEST(StretchedPart, IsWhatLiesWithinThreeSticksOfAStretchedOne) {
    Deformable cloth = make_cloth({.column_count = 60, .row_count = 60});
    const StickArrays sticks = weighted_sticks(cloth, {});
    const std::uint32_t middle = 30 * 60 + 30;
    cloth.positions[middle].z += 0.03F; // as far again as a neighbour
    PointArrays positions;
    positions.load(cloth.positions);
    StretchedPart part(sticks, cloth.particle_count());
    part.find(sticks, positions);
    ASSERT_FALSE(part.empty());
    EXPECT_TRUE(std::is_sorted(part.sticks().begin(), part.sticks().end()));
    for (std::uint32_t i = 0; i < cloth.particle_count(); ++i) {
        const int columns = std::abs(int(i % 60) - 30), rows = std::abs(int(i / 60) - 30);
        const int away = std::max(columns, rows); // sticks lead two columns or rows on
        if (away <= 3) EXPECT_EQ(part.particles()[i], 1) << i;
        if (away > 8) EXPECT_EQ(part.particles()[i], 0) << i;
    }
    for (std::uint32_t i = 0; i < sticks.count(); ++i)
        EXPECT_EQ(std::binary_search(part.sticks().begin(), part.sticks().end(), i),
                  (part.particles()[sticks.a[i]] & part.particles()[sticks.b[i]]) != 0);
}

TEST(StretchedPart, IsEmptyWhereMuchIsStretched) {
    Deformable cloth = make_cloth({.column_count = 40, .row_count = 40});
    const StickArrays sticks = weighted_sticks(cloth, {});
    for (Vec3f& p : cloth.positions) p = p * 1.5F;
    PointArrays positions;
    positions.load(cloth.positions);
    StretchedPart part(sticks, cloth.particle_count());
    part.find(sticks, positions);
    EXPECT_TRUE(part.empty());
}
