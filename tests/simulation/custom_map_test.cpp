// A cloth on a map of the user's own.

#include "support/custom_maps.hpp"
#include "support/draping.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

using namespace echinus;

namespace {

constexpr double kThickness = 0.01;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Does the simulation go through with it? All positions finite after some frames, or an orderly end.
void expect_no_harm(const Contact& answer) {
    Simulation simulation(test::sheet_at(0.2, 0.5, 9),
                          {{.map = std::make_shared<test::ConstantAnswer>(answer)}},
                          {.thickness = kThickness});
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
    Simulation simulation(test::sheet_at(1.02, 1, 15), {ball}, {.thickness = kThickness});
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
        Simulation simulation(test::sheet_at(0, 0.5, 5), std::move(colliders), {.thickness = kThickness});
        for (int i = 0; i < 20; ++i) simulation.step();
        return simulation.state_hash();
    };
    const Collider no_way_out{.map = std::make_shared<test::StuckInside>()};
    EXPECT_EQ(fallen({no_way_out}), fallen({}));
}

TEST(CustomMapSimulation, RefusesANullPointer) {
    try {
        const Simulation simulation(test::sheet_at(0, 1, 5), {{.map = std::shared_ptr<const CustomMap>()}},
                                    {});
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidOptions);
        EXPECT_NE(std::string(error.what()).find("collider 0"), std::string::npos) << error.what();
    }
}
