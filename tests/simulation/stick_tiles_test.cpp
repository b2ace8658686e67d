#include "simulation/stick_tiles.hpp"
#include "support/cloth_meshes.hpp"
#include "support/instruction_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

using namespace echinus;

namespace {

Deformable rumpled(Deformable cloth, unsigned seed) {
    test::Random random(seed);
    for (Vec3f& p : cloth.positions) p += test::in_cube(random, 0.01F);
    return cloth;
}

Deformable sheet(std::uint32_t columns, std::uint32_t rows, std::vector<std::uint32_t> pins = {}) {
    return rumpled(make_cloth({.column_count = columns, .row_count = rows, .pins = std::move(pins)}),
                   columns * 1000 + rows);
}

Deformable with_uneven_masses(Deformable cloth) {
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        cloth.inverse_masses[i] = 1.0F / static_cast<float>(1 + i % 7);
    return cloth;
}

Deformable in_any_order(Deformable cloth) {
    test::Random random(5);
    std::shuffle(cloth.sticks.begin(), cloth.sticks.end(), random);
    return cloth;
}

std::vector<Deformable> deformables() {
    const std::vector<Deformable> parts{sheet(70, 30), make_cloth(test::sheet_mesh(64, 64), {}),
                                        sheet(41, 50)};
    return {sheet(2, 2),
            sheet(17, 40),
            sheet(100, 100),
            sheet(316, 60),
            sheet(90, 40, {0, 45, 89, 1000, 1001}),
            with_uneven_masses(sheet(60, 40)),
            in_any_order(sheet(40, 40)),
            rumpled(make_cloth(test::sheet_mesh(120, 120), {}), 3),
            make_cloth(make_sphere(1, 100, 20), {}),
            rumpled(combine(parts), 4)};
}

StickArrays with_tiles(const Deformable& cloth, const SimulationOptions& options = {},
                       std::size_t thread_count = 3) {
    StickArrays sticks = weighted_sticks(cloth, options);
    sticks.tiles = cut_into_tiles(sticks, cloth.particle_count(), thread_count);
    return sticks;
}

/// Calls visit(step, tile, part) in order.
template <typename Visit>
void for_each_part(const StickTiles& all, const Visit& visit) {
    for (std::size_t step = 0; step < all.steps.size(); ++step)
        for (std::size_t t = all.steps[step].first; t < all.steps[step].first + all.steps[step].count; ++t)
            for (std::size_t i = all.tiles[t].first; i < all.tiles[t].first + all.tiles[t].count; ++i)
                visit(step, t, all.parts[i]);
}

struct Result {
    std::vector<float> places, remainders, goals;
    bool operator==(const Result&) const = default;
};

/// Four relaxations by relax(sticks, positions, remainders).
template <typename Relax>
Result relaxed(StickArrays sticks, const Deformable& cloth, bool keeps_remainders, const Relax& relax_all) {
    PointArrays positions, remainders;
    positions.load(cloth.positions);
    remainders.resize(cloth.particle_count());
    for (int i = 0; i < 4; ++i) relax_all(sticks, positions, keeps_remainders ? &remainders : nullptr);
    Result result{{}, {}, sticks.goal_lengths};
    for (std::size_t i = 0; i < cloth.particle_count(); ++i)
        for (const auto c : {&PointArrays::x, &PointArrays::y, &PointArrays::z}) {
            result.places.push_back((positions.*c)[i]);
            result.remainders.push_back((remainders.*c)[i]);
        }
    return result;
}

} // namespace

TEST(StickTiles, HaveEachStickOnce) {
    for (const Deformable& cloth : deformables()) {
        const StickArrays sticks = with_tiles(cloth);
        std::vector<int> times(sticks.count());
        for_each_part(sticks.tiles, [&](std::size_t, std::size_t, const StickRun& part) {
            for (std::size_t i = part.first; i < part.first + part.count; ++i) ++times[i];
            EXPECT_EQ(part.shape == RunShape::Disjoint || part.shape == RunShape::Scattered ||
                          (part.a == sticks.a[part.first] && part.b == sticks.b[part.first]),
                      true);
        });
        EXPECT_EQ(times, std::vector<int>(sticks.count(), 1));
    }
}

TEST(StickTiles, OfAStepShareNoParticle) {
    for (const Deformable& cloth : deformables()) {
        const StickArrays sticks = with_tiles(cloth);
        std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> last;
        for_each_part(sticks.tiles, [&](std::size_t step, std::size_t tile, const StickRun& part) {
            for (std::size_t i = part.first; i < part.first + part.count; ++i)
                for (const std::uint32_t particle : {sticks.a[i], sticks.b[i]}) {
                    const auto found = last.find(particle);
                    if (found != last.end() && found->second.first == step)
                        ASSERT_EQ(found->second.second, tile) << "step " << step;
                    last[particle] = {step, tile};
                }
        });
    }
}

TEST(StickTiles, KeepTheOrderOfSticksThatShareAParticle) {
    for (const Deformable& cloth : deformables()) {
        const StickArrays sticks = with_tiles(cloth);
        std::vector<std::size_t> next(cloth.particle_count(), 0);
        for_each_part(sticks.tiles, [&](std::size_t, std::size_t, const StickRun& part) {
            for (std::size_t i = part.first; i < part.first + part.count; ++i)
                for (const std::uint32_t particle : {sticks.a[i], sticks.b[i]}) {
                    ASSERT_GE(i + 1, next[particle]);
                    next[particle] = i + 1;
                }
        });
    }
}

/// Whatever thread is first: forwards, and backwards within each step.
TEST(StickTiles, RelaxToTheBitsOfTheRunsUnderEachInstructionSet) {
    const SimulationOptions springs{.solver = SolverKind::Xpbd, .compliance = {1e-6, 1e-5, 1e-4}};
    for (const Deformable& cloth : deformables())
        for (const SimulationOptions& options : {SimulationOptions{}, springs}) {
            const bool is_spring = options.solver == SolverKind::Xpbd;
            const StickArrays sticks = with_tiles(cloth, options);
            StickArrays backwards = sticks;
            for (const StickTiles::Range& step : backwards.tiles.steps) {
                const auto first = backwards.tiles.tiles.begin() + static_cast<std::ptrdiff_t>(step.first);
                std::reverse(first, first + static_cast<std::ptrdiff_t>(step.count));
            }
            const Result expected =
                relaxed(sticks, cloth, is_spring,
                        [](StickArrays& all, PointArrays& p, PointArrays* r) { relax(all, p, r); });
            test::under_each_instruction_set([&](std::string_view) {
                for (const StickArrays& tiled : {sticks, backwards})
                    EXPECT_EQ(relaxed(tiled, cloth, is_spring,
                                      [](StickArrays& all, PointArrays& p, PointArrays* r) {
                                          relax_tiles(all, p, r, Workers());
                                      }),
                              expected);
            });
        }
}

/// What a second thread can win at most: no more than that share of the sticks stands in steps of one tile.
TEST(StickTiles, OfALargeSheetOrMeshLieBesideEachOther) {
    for (const Deformable& cloth :
         {sheet(100, 100), sheet(316, 316), make_cloth(test::sheet_mesh(200, 200), {})}) {
        const StickArrays sticks = with_tiles(cloth, {}, 2);
        std::size_t alone = 0;
        for_each_part(sticks.tiles, [&](std::size_t step, std::size_t, const StickRun& part) {
            if (sticks.tiles.steps[step].count == 1) alone += part.count;
        });
        EXPECT_LT(static_cast<double>(alone), 0.1 * static_cast<double>(sticks.count()));
    }
}
