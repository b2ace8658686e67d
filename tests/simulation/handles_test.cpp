#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr std::uint32_t kHeldCount = 13;

/// A level sheet whose row at one end a handle holds.
Deformable held_sheet(Handle handle) {
    Deformable sheet = sheet_at(1, 0.6, kHeldCount);
    for (std::uint32_t i = 0; i < kHeldCount; ++i) handle.particles.push_back(i);
    sheet.handles = {std::move(handle)};
    return sheet;
}

void run(Simulation& simulation, double seconds) {
    while ((simulation.frame() + 0.5) * simulation.options().time_step < seconds) simulation.step();
}

std::string refusal(const std::function<void(Deformable&)>& spoil) {
    Deformable sheet = held_sheet({});
    spoil(sheet);
    return refusal_of(ErrorCode::InvalidOptions, [&] { const Simulation simulation(sheet, {}, {}); });
}

} // namespace

TEST(Handles, LeadWhatTheyHoldRigidlyAlongTheirPath) {
    const std::vector<PoseKey> keys{{0.1, {{}, {0, 0, 1}}},
                                    {0.6, {Rotation::about({0, 0, 1}, std::numbers::pi / 2), {0.5, 0, 1.5}}}};
    const Deformable sheet = held_sheet({.particles = {}, .keys = keys});
    Simulation simulation(sheet, {}, {});
    for (const double seconds : {0.1, 0.3, 0.6, 1.0}) {
        run(simulation, seconds);
        const RigidTransform pose = pose_at(keys, simulation.frame() * simulation.options().time_step);
        for (std::uint32_t i = 0; i < kHeldCount; ++i) {
            const Vec3d local = keys[0].pose.to_local(Vec3d(sheet.positions[i]));
            EXPECT_LT(length(Vec3d(simulation.positions()[i]) - pose.to_world(local)), 1e-6) << seconds;
        }
    }
    // The rest of the sheet hangs from there, in the end.
    run(simulation, 4);
    const Vec3f end = simulation.positions()[kHeldCount * kHeldCount - 1];
    EXPECT_LT(end.z, simulation.positions()[0].z - 0.3F);
}

TEST(Handles, LetGoAtTheirTimeOfWhatGoesOnWithItsVelocity) {
    // Led along x at 2 m/s for half a second and let go on the way: nothing else acts.
    Deformable particle{.positions = {{0, 0, 0}}, .inverse_masses = {1}, .constraints = {}, .faces = {}};
    particle.handles = {{{0}, {{0, {}}, {1, {{}, {2, 0, 0}}}}, 0.5}};
    SimulationOptions options;
    options.gravity = {};
    options.newton().air_drag = 0;
    Simulation simulation(particle, {}, options);
    run(simulation, 0.5);
    EXPECT_NEAR(simulation.positions()[0].x, 1, 1e-5);
    EXPECT_FALSE(simulation.at_rest());
    run(simulation, 2);
    EXPECT_NEAR(simulation.positions()[0].x, 4, 1e-3);
}

TEST(Handles, DropASheetThatHungFromThem) {
    Simulation simulation(held_sheet({.particles = {}, .release_time = 0.5}), {}, {});
    run(simulation, 0.5);
    for (std::uint32_t i = 0; i < kHeldCount; ++i) EXPECT_EQ(simulation.positions()[i].z, 1);
    run(simulation, 1);
    for (std::uint32_t i = 0; i < kHeldCount; ++i) EXPECT_LT(simulation.positions()[i].z, 0.3);
}

TEST(Handles, KeepASimulationFromRestUntilTheyHaveLetGo) {
    SimulationOptions options;
    options.gravity = {};
    options.rest.frame_count = 10;
    Simulation simulation(held_sheet({.particles = {}, .release_time = 1}), {}, options);
    run(simulation, 1);
    EXPECT_FALSE(simulation.at_rest());
    run(simulation, 1.5);
    EXPECT_TRUE(simulation.at_rest());
}

TEST(Handles, PullASheetOverABallWithoutAFaceThatMeetsIt) {
    const TriangleMesh ball = make_sphere(0.2, 30, 15);
    Deformable sheet = held_sheet(
        {.particles = {}, .keys = {{0, {{}, {0, 0, 0}}}, {1, {{}, {0, -1, -0.6}}}}, .release_time = 1});
    SimulationOptions options;
    options.thickness = 0.005;
    Simulation simulation(sheet, {{.map = ExactMap::build(ball), .pose = {{}, {0, 0, 0.7}}}}, options);
    expect_nothing_meets(simulation, {ball}, 75);
    EXPECT_EQ(simulation.profile().unresolved_count, 0u);
}

TEST(Handles, GoAlongWithTheirPartWhereDeformablesAreCombined) {
    const Deformable both = combine(std::vector{sheet_at(0, 1, 3), held_sheet({})});
    ASSERT_EQ(both.handles.size(), 1u);
    EXPECT_EQ(both.handles[0].particles.front(), 9u);
}

TEST(Handles, AreRefusedByNameWhereTheyHoldWhatTheyCannot) {
    EXPECT_EQ(refusal([](Deformable&) {}), "");
    EXPECT_EQ(refusal([](Deformable& d) { d.handles.push_back({{999}}); }),
              "handle 1 of particle 999: the last one is 168");
    EXPECT_EQ(refusal([](Deformable& d) { d.handles.push_back({}); }), "handle 1 holds no particles");
    EXPECT_EQ(refusal([](Deformable& d) { d.handles.push_back({{3}}); }),
              "handle 1 of particle 3 is not its first; a particle has at most one");
    EXPECT_EQ(refusal([](Deformable& d) { d.inverse_masses[0] = 0; }),
              "handle 0 of particle 0: it is pinned or attached already");
    expect_words(refusal([](Deformable& d) {
                     d.handles[0].keys = {{1, {}}, {1, {}}};
                 }),
                 "handle 0: keyframe 1");
    expect_words(refusal([](Deformable& d) { d.handles[0].release_time = std::nan(""); }), "handle 0");
    EXPECT_THROW(Simulation(held_sheet({}), {}, jakobsen()), Error);
}
