// Saved states: what follows has the same bits.

#include "support/expectations.hpp"
#include "support/kinds_of_simulations.hpp"
#include "support/random_points.hpp"
#include "support/saved_state_attack.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr int kFramesBefore = 10, kFramesAfter = 8;

void run(const KindOfSimulation& kind, Simulation& simulation, int frame_count) {
    for (int i = 0; i < frame_count; ++i) kind.step(simulation);
}

/// All that users see, but the times.
void expect_same(const Simulation& a, const Simulation& b) {
    EXPECT_EQ(a.state_hash(), b.state_hash());
    EXPECT_EQ(a.frame(), b.frame());
    EXPECT_EQ(a.largest_speed(), b.largest_speed());
    EXPECT_EQ(a.at_rest(), b.at_rest());
    EXPECT_EQ(a.profile().contact_count, b.profile().contact_count);
    EXPECT_EQ(a.profile().map_query_count, b.profile().map_query_count);
    EXPECT_EQ(a.profile().measured_pair_count, b.profile().measured_pair_count);
    EXPECT_EQ(a.profile().truncated_count, b.profile().truncated_count);
    for (std::size_t c = 0; c < a.colliders().size(); ++c) {
        EXPECT_EQ(a.colliders()[c].pose.translation, b.colliders()[c].pose.translation);
        EXPECT_EQ(a.load_on(c).force, b.load_on(c).force);
        EXPECT_EQ(a.load_on(c).torque, b.load_on(c).torque);
    }
    EXPECT_EQ(a.save_state(), b.save_state());
}

} // namespace

TEST(SavedState, GoesOnWithTheSameBitsInANewSimulation) {
    for (const KindOfSimulation& kind : kinds_of_simulations()) {
        SCOPED_TRACE(kind.name);
        Simulation first = kind.make();
        run(kind, first, kFramesBefore);
        const std::vector<std::byte> state = first.save_state();
        Simulation second = kind.make();
        second.restore_state(state);
        expect_same(first, second);
        for (int i = 0; i < kFramesAfter; ++i) {
            kind.step(first);
            kind.step(second);
            ASSERT_EQ(first.state_hash(), second.state_hash()) << i;
        }
        expect_same(first, second);
    }
}

TEST(SavedState, TakesASimulationBack) {
    for (const KindOfSimulation& kind : kinds_of_simulations()) {
        SCOPED_TRACE(kind.name);
        Simulation simulation = kind.make();
        const std::vector<std::byte> start = simulation.save_state();
        run(kind, simulation, kFramesAfter);
        const std::uint64_t end = simulation.state_hash();
        simulation.restore_state(start);
        EXPECT_EQ(simulation.frame(), 0u);
        run(kind, simulation, kFramesAfter);
        EXPECT_EQ(simulation.state_hash(), end);
    }
}

TEST(SavedState, KeepsTheCountOfFramesAtRest) {
    const auto make = [] {
        return Simulation(sheet_at(0.01, 0.2, 4), colliders_of({make_box({1, 1, 0.01})}),
                          jakobsen({.thickness = 0.005}));
    };
    Simulation first = make(), second = make();
    while (!first.at_rest() && first.frame() < 2000) {
        second.restore_state(first.save_state());
        first.step();
    }
    ASSERT_TRUE(first.at_rest());
    second.step();
    EXPECT_TRUE(second.at_rest());
}

TEST(SavedState, FollowsThePosesThatLeadWhenItWasSaved) {
    const auto make = [] {
        return Simulation(sheet_at(1, 1, 5), colliders_of({make_box({1, 1, 1})}), jakobsen());
    };
    Simulation first = make(), second = make();
    first.set_collider_pose(0, {{}, {0.1, 0, 0}});
    second.restore_state(first.save_state());
    first.step();
    second.step();
    EXPECT_EQ(second.colliders()[0].pose.translation, first.colliders()[0].pose.translation);
    EXPECT_NEAR(second.colliders()[0].pose.translation.x, 0.1, 1e-12);
}

TEST(SavedState, IsRefusedByAnotherSimulationInASentenceThatSaysWhatDiffers) {
    const KindOfSimulation kind = sheet_on_deforming_balls();
    Simulation saved = kind.make();
    run(kind, saved, 3);
    const std::vector<std::byte> state = saved.save_state();
    const auto expect_refused = [&](const std::string& words,
                                    const std::function<void(KindOfSimulation&)>& change) {
        KindOfSimulation other = kind;
        change(other);
        Simulation simulation = other.make();
        const std::uint64_t before = simulation.state_hash();
        expect_error(ErrorCode::InvalidOptions, words, [&] { simulation.restore_state(state); });
        EXPECT_EQ(simulation.state_hash(), before);
        EXPECT_EQ(simulation.frame(), 0u);
    };
    expect_refused("other options", [](KindOfSimulation& k) { k.options.friction = 0.1; });
    expect_refused("other options",
                   [](KindOfSimulation& k) { k.options.newton().collision = CollisionMode::Surfaces; });
    expect_refused("another deformable", [](KindOfSimulation& k) { k.deformable.constraints.pop_back(); });
    expect_refused("other initial positions",
                   [](KindOfSimulation& k) { k.deformable.positions[0].z += 0.01F; });
    expect_refused("2 colliders, not 3", [](KindOfSimulation& k) {
        k.colliders.push_back(k.colliders[0]);
        k.colliders[2].pose.translation = {0, 0, -5};
    });
    expect_refused("collider 1", [](KindOfSimulation& k) { k.colliders[1].scale = {0.5, 0.5, 0.5}; });
    expect_refused("follows none here", [](KindOfSimulation& k) { k.begin = [](Simulation&) {}; });
    expect_refused("follows another one here", [](KindOfSimulation& k) {
        k.begin = [](Simulation& s) {
            VertexCache cache = breathing_cache();
            cache.start_time = 0.5;
            s.set_collider_cache(1, cache);
        };
    });
}

TEST(SavedState, IsRefusedWhereItIsTruncatedChangedOrNone) {
    const KindOfSimulation kind = sheet_among_moving_colliders();
    Simulation simulation = kind.make();
    run(kind, simulation, 5);
    const std::vector<std::byte> state = simulation.save_state();
    const std::uint64_t before = simulation.state_hash();
    const auto expect_refused = [&](ErrorCode code, std::vector<std::byte> bytes) {
        expect_error(code, "the saved state", [&] { simulation.restore_state(bytes); });
    };
    expect_refused(ErrorCode::WrongFormat, {});
    expect_refused(ErrorCode::WrongFormat, std::vector<std::byte>(100));
    for (const std::size_t count : {std::size_t{40}, state.size() / 2, state.size() - 1})
        expect_refused(ErrorCode::Damaged,
                       {state.begin(), state.begin() + static_cast<std::ptrdiff_t>(count)});
    std::vector<std::byte> longer = state;
    longer.push_back({});
    expect_refused(ErrorCode::Damaged, longer);
    for (std::size_t i = 32; i < state.size(); i += state.size() / 50) {
        std::vector<std::byte> changed = state;
        changed[i] ^= std::byte{1};
        expect_refused(ErrorCode::Damaged, changed);
    }
    std::vector<std::byte> newer = state;
    newer[8] = std::byte{99};
    expect_refused(ErrorCode::UnsupportedVersion, newer);
    EXPECT_EQ(simulation.state_hash(), before);
}

TEST(SavedState, OfHostileBytesIsRefusedOrHarmless) {
    Random random(5);
    for (const KindOfSimulation& kind : {sheet_on_deforming_balls(), sheet_among_moving_colliders()}) {
        const Simulation fresh = kind.make();
        Simulation simulation = fresh;
        run(kind, simulation, 12);
        const std::vector<std::byte> state = simulation.save_state();
        int refused = 0;
        for (int i = 0; i < 24; ++i) {
            std::vector<std::byte> changed = state;
            for (int k = 0; k < 1 << (i % 8); ++k)
                changed[32 + random() % (state.size() - 32)] = static_cast<std::byte>(random() % 256);
            mend_checksum(changed);
            Simulation attacked = fresh;
            try {
                attacked.restore_state(changed);
                run(kind, attacked, 2);
            } catch (const Error&) {
                ++refused;
            }
        }
        EXPECT_GT(refused, 0);
    }
}

class SavedStateFile : public TemporaryFolderTest {};

TEST_F(SavedStateFile, GoesOnWithTheSameBits) {
    const KindOfSimulation kind = sheet_on_a_turning_box();
    Simulation first = kind.make(), second = kind.make();
    run(kind, first, 10);
    first.save_state(path("cloth.state"));
    second.restore_state(path("cloth.state"));
    run(kind, first, 10);
    run(kind, second, 10);
    expect_same(first, second);
}

TEST_F(SavedStateFile, IsNamedInErrors) {
    Simulation simulation = sheet_on_a_turning_box().make();
    expect_error(ErrorCode::Unreadable, "none.state", [&] { simulation.restore_state(path("none.state")); });
    expect_error(ErrorCode::WrongFormat, "other.state",
                 [&] { simulation.restore_state(write("other.state", "no state")); });
    expect_error(ErrorCode::Unwritable, "folder",
                 [&] { simulation.save_state(path("folder") / "cloth.state"); });
}

// The same bits on any number of threads.

namespace {

/// Large enough that threads share particles and elements: a sheet with pins over a soft body, which fall
/// onto a torus.
Simulation large(bool surfaces, unsigned thread_count) {
    Deformable sheet = sheet_at(0.6, 1, 70);
    sheet.inverse_masses[37] = sheet.inverse_masses[3000] = 0;
    std::vector<Deformable> parts{sheet};
    SimulationOptions options = surfaces_for_kinds(true);
    if (surfaces)
        parts.push_back(make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {8, 8, 8}),
                                       {.young_modulus = 1e4, .damping = 0.01, .pose = {{}, {0, 0, 0.27}}}));
    else
        options = jakobsen({.thickness = 0.01});
    options.thread_count = thread_count;
    return {combine(parts), colliders_of({make_torus(0.3, 0.15, 24, 12)}), options};
}

} // namespace

TEST(ThreadCount, DecidesNoBits) {
    for (const KindOfSimulation& kind : kinds_of_simulations()) {
        SCOPED_TRACE(kind.name);
        Simulation one = kind.make(1), two = kind.make(2), three = kind.make(3);
        for (int i = 0; i < 12; ++i) {
            for (Simulation* simulation : {&one, &two, &three}) kind.step(*simulation);
            ASSERT_EQ(two.state_hash(), one.state_hash()) << i;
            ASSERT_EQ(three.state_hash(), one.state_hash()) << i;
        }
        // All that the next frames depend on.
        EXPECT_EQ(two.save_state(), one.save_state());
        EXPECT_EQ(three.save_state(), one.save_state());
    }
}

TEST(ThreadCount, DecidesNoBitsWhereThreadsShareParticlesAndElements) {
    for (const bool surfaces : {false, true}) {
        SCOPED_TRACE(surfaces);
        Simulation one = large(surfaces, 1), two = large(surfaces, 2), three = large(surfaces, 3);
        for (int i = 0; i < (surfaces ? 3 : 40); ++i) {
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
    for (int i = 0; i < 8; ++i) kind.step(one);
    two.restore_state(one.save_state());
    EXPECT_EQ(two.options().thread_count, 2u);
    Simulation copy = two;
    for (int i = 0; i < 8; ++i)
        for (Simulation* simulation : {&one, &two, &copy}) kind.step(*simulation);
    EXPECT_EQ(two.save_state(), one.save_state());
    EXPECT_EQ(copy.save_state(), one.save_state());
}

/// A vertex at the model's origin, where one would be by mistake whose pairs are listed there.
TEST(SavedState, OfASimulationThatHasNotBegunChangesNoPairs) {
    TriangleMesh box = make_box({1, 1, 0.2}, 4);
    for (Vec3f& v : box.vertices) v.z -= 0.1F;
    const auto falls = [&](bool is_saved) {
        Simulation simulation(
            sheet_at(0.003, 1, 5), colliders_of({box}),
            {.solver = NewtonOptions{.collision = CollisionMode::Surfaces}, .thickness = 0.01});
        if (is_saved) simulation.save_state();
        for (int i = 0; i < 5; ++i) simulation.step();
        return simulation.profile().measured_pair_count;
    };
    EXPECT_EQ(falls(true), falls(false));
}
