#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

const TriangleMesh kBall = make_sphere(0.2, 30, 15);

SimulationOptions with_both_contacts() {
    SimulationOptions options;
    options.thickness = 0.005;
    // A step that may stop short of its solution does so at different positions after a teleport.
    options.newton().tolerance = 1e-7;
    return options;
}

/// A sheet that has come to rest on a ball, beside a box that is far away.
Simulation sheet_on_ball() {
    Simulation simulation(sheet_at(0.21, 0.5, 15),
                          {{.map = ExactMap::build(kBall)},
                           {.map = ExactMap::build(make_box({0.1, 0.1, 0.1})), .pose = {{}, {0, 0, 3}}}},
                          with_both_contacts());
    for (int i = 0; i < 90; ++i) simulation.step();
    return simulation;
}

double farthest_between(const Simulation& a, const Simulation& b, const RigidTransform& motion) {
    double farthest = 0;
    for (std::size_t i = 0; i < a.positions().size(); ++i)
        farthest =
            std::max(farthest, length(motion.to_world(Vec3d(a.positions()[i])) - Vec3d(b.positions()[i])));
    return farthest;
}

std::string refusal(Simulation& simulation, const Teleport& teleport) {
    return refusal_of(ErrorCode::InvalidOptions, [&] { simulation.teleport(teleport); });
}

} // namespace

TEST(Teleport, TakesAClothAlongWithItsModelAsIfNothingHadHappened) {
    Simulation stays = sheet_on_ball();
    Simulation goes = stays;
    // Turned about the vertical, along which gravity pulls.
    const RigidTransform motion{Rotation::about({0, 0, 1}, 0.5), {5, -3, 2}};
    goes.teleport({.motion = motion, .colliders = {0}});
    EXPECT_LT(farthest_between(stays, goes, motion), 1e-6);
    EXPECT_LT(length(goes.colliders()[0].pose.translation - Vec3d{5, -3, 2}), 1e-12);
    EXPECT_EQ(goes.colliders()[1].pose.translation, (Vec3d{0, 0, 3}));
    for (int i = 0; i < 30; ++i) {
        stays.step();
        goes.step();
    }
    EXPECT_LT(farthest_between(stays, goes, motion), 1e-4);
    EXPECT_LT(goes.largest_speed(), stays.largest_speed() + 0.01);
    EXPECT_EQ(meeting_faces(goes, {kBall, make_box({0.1, 0.1, 0.1})}).size(), 0u);
}

TEST(Teleport, OfAModelAloneLeavesTheClothWhereItIsAndDragsNothingAlong) {
    Simulation simulation = sheet_on_ball();
    const std::vector<Vec3f> before(simulation.positions().begin(), simulation.positions().end());
    simulation.teleport({.motion = {{}, {2, 0, 0}}, .colliders = {0}, .deformable = false});
    simulation.step();
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT(length(simulation.positions()[i] - before[i]), 0.01F) << i;
    for (int i = 0; i < 29; ++i) simulation.step();
    // Half a second later it has fallen, all but straight.
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT(simulation.positions()[i].z, before[i].z - 0.5F);
}

TEST(Teleport, ComesInTheFrameOfItsTime) {
    SimulationOptions options;
    options.gravity = {};
    Simulation simulation(sheet_at(0, 1, 5), {}, options);
    simulation.teleport({.motion = {{}, {1, 0, 0}}, .time = 0.1});
    const float before = simulation.positions()[0].x;
    for (int i = 0; i < 6; ++i) simulation.step(); // the seventh begins at 0.1 s
    EXPECT_EQ(simulation.positions()[0].x, before);
    EXPECT_FALSE(simulation.at_rest());
    simulation.step();
    EXPECT_NEAR(simulation.positions()[0].x, before + 1, 1e-6);
}

TEST(Teleport, TakesPinsHandlesAndKeyframesAlong) {
    Deformable sheet = sheet_at(0.5, 0.4, 9);
    sheet.inverse_masses[0] = 0;
    sheet.handles = {{{8}, {{0, {}}, {2, {{}, {0, 0, 1}}}}}};
    Simulation simulation(sheet, {{.map = ExactMap::build(kBall)}}, with_both_contacts());
    simulation.set_collider_keyframes(0, {{0, {}}, {2, {{}, {0, 0.5, 0}}}});
    for (int i = 0; i < 30; ++i) simulation.step();
    Simulation goes = simulation;
    const RigidTransform motion{Rotation::about({0, 0, 1}, 1), {3, 0, 0}};
    goes.teleport({.motion = motion, .colliders = {0}});
    for (int i = 0; i < 30; ++i) {
        simulation.step();
        goes.step();
    }
    for (const std::size_t held : {0u, 8u})
        EXPECT_LT(
            length(motion.to_world(Vec3d(simulation.positions()[held])) - Vec3d(goes.positions()[held])),
            1e-5);
    EXPECT_LT(length(motion.to_world(simulation.colliders()[0].pose.translation) -
                     goes.colliders()[0].pose.translation),
              1e-9);
    EXPECT_LT(farthest_between(simulation, goes, motion), 1e-3);
}

TEST(Teleport, IsRefusedWhereTheClothWouldMeetAModelAndChangesNothing) {
    Simulation simulation = sheet_on_ball();
    const std::uint64_t before = simulation.state_hash();
    const std::string sentence =
        refusal(simulation, {.motion = {{}, {0, 0, -2.8}}, .colliders = {1}, .deformable = false});
    expect_words(sentence, "a teleport moves the deformable and collider 1 to where");
    EXPECT_EQ(simulation.state_hash(), before);
    EXPECT_EQ(simulation.colliders()[1].pose.translation, (Vec3d{0, 0, 3}));
    // One that is to come is refused by the frame in which it comes, and then forgotten.
    simulation.teleport(
        {.motion = {{}, {0, 0, -2.8}}, .colliders = {1}, .deformable = false, .time = 1e-3 + 1.5});
    EXPECT_NO_THROW(simulation.step());
    EXPECT_THROW(simulation.step(), Error);
    EXPECT_NO_THROW(simulation.step());
}

TEST(Teleport, NamesWhatIsWrong) {
    Simulation simulation = sheet_on_ball();
    expect_words(refusal(simulation, {.motion = {{2, 0, 0, 0}, {}}}), "a teleport has the rotation");
    expect_words(refusal(simulation, {.motion = {}, .colliders = {2}}), "collider 2 of 2");
    expect_words(refusal(simulation, {.motion = {}, .time = std::nan("")}), "time");
    Simulation particles(sheet_at(1, 1, 3), {}, jakobsen());
    expect_words(refusal(particles, {}), "newton");
    Deformable attached = sheet_at(0.5, 0.4, 9);
    attached.inverse_masses[4] = 0;
    attached.attachments = {{4, 0}};
    Simulation held(attached, {{.map = ExactMap::build(kBall)}}, with_both_contacts());
    expect_words(refusal(held, {.motion = {{}, {1, 0, 0}}}), "particle 4 and collider 0");
    EXPECT_EQ(refusal(held, {.motion = {{}, {1, 0, 0}}, .colliders = {0}}), "");
}
