#pragma once

#include <echinus/simulation.hpp>

#include <gtest/gtest.h>

#include <cstdint>

namespace echinus::test {

/// A level square cloth with its middle above the origin.
inline Deformable sheet_at(double height, double width, std::uint32_t count, const Vec3d& velocity = {}) {
    Deformable sheet = make_cloth({.column_count = count,
                                   .row_count = count,
                                   .width = width,
                                   .height = width,
                                   .pose = {Rotation{}, {0, 0, height}}});
    if (velocity != Vec3d{}) sheet.velocities.assign(sheet.particle_count(), Vec3f(velocity));
    return sheet;
}

/// The paper's solver, in its usual steps unless told otherwise.
inline SimulationOptions jakobsen(SimulationOptions options = {}) {
    if (options.kind() != SolverKind::Jakobsen) options.solver = JakobsenOptions{};
    if (options.time_step == SimulationOptions{}.time_step) options.time_step = 1.0 / 240;
    return options;
}

/// Runs until rest; fails when that takes more than `frame_limit` frames.
inline void run_to_rest(Simulation& simulation, std::uint32_t frame_limit) {
    while (!simulation.at_rest() && simulation.frame() < frame_limit) simulation.step();
    EXPECT_TRUE(simulation.at_rest()) << "speed " << simulation.largest_speed();
}

/// A small cloth of 7 x 7 particles along a slope through the origin, this far above it.
inline Deformable sheet_on_slope(const Rotation& tilt, double height) {
    return make_cloth({.column_count = 7,
                       .row_count = 7,
                       .width = 0.3,
                       .height = 0.3,
                       .pose = {tilt, tilt.apply({0, 0, height})}});
}

/// How far the middle of a small cloth slides in half a second on a slope of this angle with a friction of
/// 0.5.
/// @param box  the map of make_box({2, 2, 1})
/// @param options  of which thickness and friction are replaced
inline float slid_down_slope(const ColliderMap& box, double angle_rad, SimulationOptions options = {}) {
    constexpr double kThickness = 0.01;
    const Rotation tilt = Rotation::about({1, 0, 0}, angle_rad);
    const Deformable sheet = sheet_on_slope(tilt, 0.5 + kThickness);
    options.thickness = kThickness;
    options.friction = 0.5;
    Simulation simulation(sheet, {{.map = box, .pose = {tilt, {}}}}, options);
    const std::size_t middle = sheet.particle_count() / 2;
    const Vec3f before = simulation.positions()[middle];
    while (simulation.frame() * options.time_step < 0.5) simulation.step();
    return length(simulation.positions()[middle] - before);
}

/// Expects all particles outside the unit ball and a good part of them on it.
inline void expect_draped_over_unit_ball(const Simulation& simulation, double thickness) {
    std::size_t touching = 0;
    for (const Vec3f& p : simulation.positions()) {
        EXPECT_GT(length(p), 0.999);
        touching += length(p) < 1 + 2 * thickness ? 1 : 0;
    }
    EXPECT_GT(touching, simulation.positions().size() / 4);
}

} // namespace echinus::test
