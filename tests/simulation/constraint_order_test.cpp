#include "simulation/constraint_order.hpp"
#include "simulation/constraint_schedule.hpp"
#include "simulation/tetrahedra.hpp"
#include "support/cloth_meshes.hpp"
#include "support/kinds_of_simulations.hpp"
#include "support/random_points.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <vector>

using namespace echinus;
using namespace echinus::test;

// The order in which constraints are relaxed, and what of it may be done at once.

namespace {

constexpr std::size_t kPerSlab = 100;

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

ConstraintParticles particles_of(const Pairs& pairs, std::size_t particle_count) {
    return {pairs.size(), particle_count, [&](std::size_t i) { return pairs[i]; }};
}

/// Of a strip, with links from one particle to the next few.
Pairs strip(std::uint32_t particle_count, std::uint32_t reach) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < particle_count; ++i)
        for (std::uint32_t k = 1; k <= reach && i + k < particle_count; ++k) pairs.push_back({i, i + k});
    return pairs;
}

Pairs ordered(const Pairs& pairs, std::size_t particle_count) {
    Pairs result;
    for (const std::uint32_t i : relaxation_order(particles_of(pairs, particle_count), kPerSlab))
        result.push_back(pairs[i]);
    return result;
}

/// Pieces follow one another, and those of a phase have no particle in common.
void expect_sound(const ConstraintPieces& cut, const ConstraintParticles& constraints) {
    std::size_t next = 0, next_piece = 0;
    for (const ConstraintRun& phase : cut.phases) {
        EXPECT_EQ(phase.first, next_piece);
        next_piece += phase.count;
        std::set<std::uint32_t> of_phase;
        for (std::size_t p = phase.first; p < next_piece; ++p) {
            EXPECT_EQ(cut.pieces[p].first, next);
            next += cut.pieces[p].count;
            std::set<std::uint32_t> of_piece;
            for (std::size_t i = cut.pieces[p].first; i < next; ++i)
                of_piece.insert(constraints.of(i).begin(), constraints.of(i).end());
            for (const std::uint32_t particle : of_piece) EXPECT_TRUE(of_phase.insert(particle).second);
        }
    }
    EXPECT_EQ(next, constraints.count());
    EXPECT_EQ(next_piece, cut.pieces.size());
}

void expect_slabs(const Pairs& pairs, std::size_t particle_count, std::size_t most_phases,
                  std::size_t least_pieces) {
    const ConstraintParticles constraints = particles_of(pairs, particle_count);
    const ConstraintPieces cut = independent_pieces(constraints, kPerSlab);
    expect_sound(cut, constraints);
    EXPECT_LE(cut.phases.size(), most_phases);
    EXPECT_GT(cut.pieces.size(), least_pieces);
}

} // namespace

TEST(ConstraintOrder, HasEachConstraintOnce) {
    test::Random random(1);
    for (const std::uint32_t count : {0u, 1u, 2u, 50u, 3000u}) {
        Pairs pairs = strip(count, 3);
        std::shuffle(pairs.begin(), pairs.end(), random);
        Pairs result = ordered(pairs, count);
        std::sort(pairs.begin(), pairs.end());
        std::sort(result.begin(), result.end());
        EXPECT_EQ(result, pairs);
    }
}

TEST(ConstraintOrder, OfAStripIsTwoPhasesOfSlabsInWholePacks) {
    constexpr std::uint32_t kParticles = 3000;
    const Pairs pairs = ordered(strip(kParticles, 3), kParticles);
    const ConstraintParticles constraints = particles_of(pairs, kParticles);
    const ConstraintPieces cut = independent_pieces(constraints, kPerSlab);
    expect_sound(cut, constraints);
    ASSERT_EQ(cut.phases.size(), 2u);
    EXPECT_GT(cut.pieces.size(), 60u);
    for (const ConstraintRun& piece : cut.pieces) EXPECT_LT(piece.count, 3 * kPerSlab);
    std::size_t in_packs = 0;
    for (const ConstraintRun& run : schedule_of(constraints, kPerSlab).runs)
        in_packs += run.count / kConstraintsPerPack * kConstraintsPerPack;
    EXPECT_GT(in_packs, constraints.count() * 9 / 10);
}

TEST(ConstraintOrder, LeavesWhatClosesARingToTheEnd) {
    constexpr std::uint32_t kParticles = 3000;
    Pairs ring = strip(kParticles, 3);
    for (std::uint32_t i = 0; i < 3; ++i) ring.push_back({i, kParticles - 1 - i});
    expect_slabs(ordered(ring, kParticles), kParticles, 3, 60);
}

TEST(ConstraintSchedule, FindsTheSlabsWhereConstraintsAreMissing) {
    constexpr std::uint32_t kParticles = 3000;
    test::Random random(2);
    Pairs pairs = ordered(strip(kParticles, 3), kParticles);
    std::erase_if(pairs, [&](const auto&) { return random() % 5 == 0; });
    expect_slabs(pairs, kParticles, 4, 50);
}

TEST(ConstraintSchedule, IsSoundWhateverTheOrder) {
    test::Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        Pairs pairs = strip(400, 1 + static_cast<std::uint32_t>(trial % 4));
        std::shuffle(pairs.begin(), pairs.end(), random);
        const ConstraintParticles constraints = particles_of(pairs, 400);
        expect_sound(independent_pieces(constraints, 8), constraints);
    }
}

TEST(ConstraintSchedule, OfABodyHasSlabsForSeveralThreads) {
    const Deformable body = make_soft_body(make_solid_box({1, 0.2, 0.2}, {40, 8, 8}), {});
    const TetrahedronArrays all = weighted_tetrahedra(body, {.solver = SolverKind::Xpbd});
    EXPECT_LE(all.schedule.phases.size(), 3u);
    EXPECT_GE(all.schedule.phases.front().count, 4u);
}

// The same bits on any number of threads.

namespace {

/// Large enough that threads share constraints and particles: a sheet with pins, a cloth of a mesh with folds
/// and a body of many tetrahedra, which fall onto a torus.
Simulation large(SolverKind solver, bool surfaces, unsigned thread_count) {
    Deformable sheet = sheet_at(0.3, 1, 120);
    sheet.inverse_masses[37] = sheet.inverse_masses[7000] = 0;
    std::vector<Deformable> parts{sheet};
    if (solver == SolverKind::Xpbd) {
        parts.push_back(make_cloth(rumpled(sheet_mesh(70, 70), 0.002F), {.pose = {{}, {0, 0, 0.6}}}));
        parts.push_back(make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {12, 12, 12}),
                                       {.young_modulus = 1e4, .damping = 0.01, .pose = {{}, {0, 0, 1}}}));
    }
    SimulationOptions options = surfaces_for_kinds(surfaces);
    options.surface_collision = surfaces;
    options.solver = solver;
    options.iteration_count = 2;
    options.substep_count = solver == SolverKind::Xpbd ? 3 : 1;
    options.compliance = {1e-7, 1e-6, 1e-4};
    options.thread_count = thread_count;
    return {combine(parts), colliders_of({make_torus(0.3, 0.15, 24, 12)}), options};
}

} // namespace

TEST(ThreadCount, DecidesNoBits) {
    for (const KindOfSimulation& kind : kinds_of_simulations()) {
        SCOPED_TRACE(kind.name);
        Simulation one = kind.make(1), two = kind.make(2), three = kind.make(3);
        for (int i = 0; i < 60; ++i) {
            for (Simulation* simulation : {&one, &two, &three}) kind.step(*simulation);
            ASSERT_EQ(two.state_hash(), one.state_hash()) << i;
            ASSERT_EQ(three.state_hash(), one.state_hash()) << i;
        }
        // All that the next frames depend on.
        EXPECT_EQ(two.save_state(), one.save_state());
        EXPECT_EQ(three.save_state(), one.save_state());
    }
}

TEST(ThreadCount, DecidesNoBitsWhereThreadsShareConstraintsAndParticles) {
    for (const SolverKind solver : {SolverKind::Verlet, SolverKind::Xpbd})
        for (const bool surfaces : {false, true}) {
            SCOPED_TRACE(surfaces);
            Simulation one = large(solver, surfaces, 1), two = large(solver, surfaces, 2),
                       three = large(solver, surfaces, 3);
            for (int i = 0; i < (surfaces ? 4 : 40); ++i) {
                for (Simulation* simulation : {&one, &two, &three}) simulation->step();
                ASSERT_EQ(two.state_hash(), one.state_hash()) << i;
                ASSERT_EQ(three.state_hash(), one.state_hash()) << i;
            }
            EXPECT_EQ(two.save_state(), one.save_state());
            EXPECT_EQ(three.profile().map_query_count, one.profile().map_query_count);
            EXPECT_EQ(three.profile().contact_count, one.profile().contact_count);
        }
}

TEST(ThreadCount, MayChangeWithASavedStateOrACopy) {
    const KindOfSimulation kind = sheet_among_moving_colliders();
    Simulation one = kind.make(1), two = kind.make(2);
    for (int i = 0; i < 20; ++i) kind.step(one);
    two.restore_state(one.save_state());
    EXPECT_EQ(two.options().thread_count, 2u);
    Simulation copy = two;
    for (int i = 0; i < 20; ++i)
        for (Simulation* simulation : {&one, &two, &copy}) kind.step(*simulation);
    EXPECT_EQ(two.save_state(), one.save_state());
    EXPECT_EQ(copy.save_state(), one.save_state());
}
