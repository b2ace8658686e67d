// The same bits on any number of threads.

#include "support/kinds_of_simulations.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

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
