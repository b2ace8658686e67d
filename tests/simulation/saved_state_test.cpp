// Saved states: what follows has the same bits.

#include "simulation/state/state_archive.hpp"
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

constexpr int kFramesBefore = 30, kFramesAfter = 30;

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
        if (!a.options().measure_loads) continue;
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
                          {.thickness = 0.005});
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
        return Simulation(sheet_at(1, 1, 5), colliders_of({make_box({1, 1, 1})}), SimulationOptions{});
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
    expect_refused("other options", [](KindOfSimulation& k) { k.options.self_collision = false; });
    expect_refused("another deformable", [](KindOfSimulation& k) { k.deformable.sticks.pop_back(); });
    expect_refused("began elsewhere", [](KindOfSimulation& k) { k.deformable.positions[0].z += 0.01F; });
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
        Simulation simulation = kind.make();
        run(kind, simulation, 20);
        const std::vector<std::byte> state = simulation.save_state();
        int refused = 0;
        for (int i = 0; i < 60; ++i) {
            std::vector<std::byte> changed = state;
            for (int k = 0; k < 1 << (i % 8); ++k)
                changed[32 + random() % (state.size() - 32)] = static_cast<std::byte>(random() % 256);
            mend_checksum(changed);
            Simulation attacked = kind.make();
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

TEST(SavedState, DoesNotChangeWhatKernelsReadBehindTheParticles) {
    PointArrays forged;
    forged.resize(3);
    forged.fill(1e30F);
    StateArchive writer;
    writer.points(forged);
    writer.padded(forged.x);
    StateArchive reader(writer.written(), "forged");
    PointArrays points;
    points.resize(3);
    std::vector<float> clearances(3 + PointArrays::kPadding, 7);
    reader.points(points);
    reader.padded(clearances);
    reader.finish();
    for (std::size_t i = 0; i < clearances.size(); ++i) {
        EXPECT_EQ(points.y[i], i < 3 ? 1e30F : 0) << i;
        EXPECT_EQ(clearances[i], i < 3 ? 1e30F : 7) << i;
    }
}

class SavedStateFile : public TemporaryFolderTest {};

TEST_F(SavedStateFile, GoesOnWithTheSameBits) {
    const KindOfSimulation kind = stretched_sheet();
    Simulation first = kind.make(), second = kind.make();
    run(kind, first, 10);
    first.save_state(path("cloth.state"));
    second.restore_state(path("cloth.state"));
    run(kind, first, 10);
    run(kind, second, 10);
    expect_same(first, second);
}

TEST_F(SavedStateFile, IsNamedInErrors) {
    Simulation simulation = stretched_sheet().make();
    expect_error(ErrorCode::Unreadable, "none.state", [&] { simulation.restore_state(path("none.state")); });
    expect_error(ErrorCode::WrongFormat, "other.state",
                 [&] { simulation.restore_state(write("other.state", "no state")); });
    expect_error(ErrorCode::Unwritable, "folder",
                 [&] { simulation.save_state(path("folder") / "cloth.state"); });
}
