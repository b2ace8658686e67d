#include "support/draping.hpp"
#include "support/expectations.hpp"
#include "support/surface_judge.hpp"

#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

Vec3d mean_place(const Simulation& simulation) {
    Vec3d sum;
    for (const Vec3f& place : simulation.positions()) sum += Vec3d(place);
    return sum * (1 / static_cast<double>(simulation.positions().size()));
}

/// Of all particles from a place.
double mean_radius(const Simulation& simulation, const Vec3d& middle) {
    double sum = 0;
    for (const Vec3f& place : simulation.positions()) sum += length(Vec3d(place) - middle);
    return sum / static_cast<double>(simulation.positions().size());
}

double height_of(const Simulation& simulation) {
    const auto [lowest, highest] =
        std::minmax_element(simulation.positions().begin(), simulation.positions().end(),
                            [](const Vec3f& a, const Vec3f& b) { return a.z < b.z; });
    return double{highest->z} - double{lowest->z};
}

std::string refusal(const Deformable& deformable, SimulationOptions options) {
    options.newton().pressure = 100;
    return refusal_of(ErrorCode::InvalidOptions,
                      [&] { const Simulation simulation(deformable, {}, options); });
}

/// Two squares that are sewn together along their border.
/// @param away  of the middles from each other, half of it
TriangleMesh pillow(float away) {
    constexpr std::uint32_t kCount = 13;
    TriangleMesh mesh;
    std::array<std::array<std::uint32_t, kCount * kCount>, 2> number{};
    for (std::size_t side = 0; side < 2; ++side)
        for (std::uint32_t i = 0; i < kCount * kCount; ++i) {
            const std::uint32_t row = i / kCount, column = i % kCount;
            const bool is_border = row % (kCount - 1) == 0 || column % (kCount - 1) == 0;
            if (side == 1 && is_border) {
                number[1][i] = number[0][i];
                continue;
            }
            number[side][i] = static_cast<std::uint32_t>(mesh.vertices.size());
            const auto along = [](std::uint32_t k) {
                return 0.4F * static_cast<float>(k) / (kCount - 1) - 0.2F;
            };
            mesh.vertices.push_back({along(column), along(row), is_border ? 0 : side == 0 ? away : -away});
        }
    for (std::size_t side = 0; side < 2; ++side)
        for (std::uint32_t row = 0; row + 1 < kCount; ++row)
            for (std::uint32_t column = 0; column + 1 < kCount; ++column) {
                const std::uint32_t i = row * kCount + column;
                const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                    if (side == 1) std::swap(b, c);
                    mesh.faces.push_back({number[side][a], number[side][b], number[side][c]});
                };
                // Diagonals that leave no face with three corners on the border.
                const bool turns = (row < kCount / 2) == (column < kCount / 2);
                if (turns) {
                    add(i, i + 1, i + kCount + 1);
                    add(i, i + kCount + 1, i + kCount);
                } else {
                    add(i, i + 1, i + kCount);
                    add(i + 1, i + kCount + 1, i + kCount);
                }
            }
    return mesh;
}

/// Turns every face round.
Deformable inside_out(Deformable deformable) {
    for (Triangle& face : deformable.faces) std::swap(face[1], face[2]);
    return deformable;
}

} // namespace

TEST(Pressure, InflatesABallAsFarAsItsMembraneBears) {
    constexpr double kRadius = 0.3, kPressure = 200;
    const Deformable ball = make_cloth(make_sphere(kRadius, 40, 20), MeshClothOptions{});
    SimulationOptions options;
    options.gravity = {};
    options.newton().air_drag = 5;
    options.newton().pressure = kPressure;
    for (const Deformable& bag : {ball, inside_out(ball)}) {
        Simulation simulation(bag, {}, options);
        for (int i = 0; i < 240; ++i) simulation.step();
        // Where 4 pi R^2 k e^2 - p (4/3) pi (R (1 + e))^3 is least: e = p R (1 + e)^2 / (2 k).
        double strain = 0;
        for (int i = 0; i < 20; ++i)
            strain = kPressure * kRadius * (1 + strain) * (1 + strain) /
                     (2 * options.newton().material.stretch_stiffness);
        EXPECT_NEAR(mean_radius(simulation, {}) / kRadius - 1, strain, 0.05 * strain);
        EXPECT_LT(simulation.largest_speed(), 1e-3);
        EXPECT_LT(length(mean_place(simulation)), 1e-5); // and it stays where it is
    }
}

TEST(Pressure, OfTheSameBallIsTheSameFarFromTheOrigin) {
    Deformable ball = make_cloth(make_sphere(0.3, 20, 10), MeshClothOptions{});
    SimulationOptions options;
    options.gravity = {};
    options.newton().pressure = 200;
    Simulation near(ball, {}, options);
    for (Vec3f& place : ball.positions) place = place + Vec3f{1000, 0, 0};
    ball.rest_positions = near.deformable().rest_positions;
    Simulation far(ball, {}, options);
    for (int i = 0; i < 60; ++i) {
        near.step();
        far.step();
    }
    EXPECT_NEAR(mean_radius(far, {1000, 0, 0}), mean_radius(near, {}), 1e-4);
    EXPECT_LT(length(mean_place(far) - Vec3d{1000, 0, 0}), 1e-3);
}

TEST(Pressure, BearsAPillowThatLiesFlatWithoutIt) {
    const TriangleMesh floor = make_box({2, 2, 0.1});
    const auto height = [&](double pressure) {
        MeshClothOptions cloth;
        cloth.rest_vertices = pillow(0).vertices;
        cloth.pose.translation = {0, 0, 0.1};
        SimulationOptions options;
        options.thickness = 0.005;
        options.newton().air_drag = 2;
        options.newton().pressure = pressure;
        Simulation simulation(make_cloth(pillow(0.02), cloth), {{.map = ExactMap::build(floor)}}, options);
        for (int i = 0; i < 90; ++i) simulation.step();
        EXPECT_EQ(meeting_faces(simulation, {floor}).size(), 0u) << pressure;
        EXPECT_EQ(simulation.profile().unresolved_count, 0u) << pressure;
        // All of its weight rests on the floor.
        EXPECT_NEAR(simulation.load_on(0).force.z, -9.81 * 0.2 * 2 * 0.16, 0.05) << pressure;
        return height_of(simulation);
    };
    EXPECT_LT(height(0), 0.05);
    EXPECT_GT(height(50), 0.12);
}

TEST(Pressure, IsInClosedPiecesAlone) {
    // Of a ball and a sheet that fall side by side only the ball becomes larger; and a body's faces have
    // none.
    const Deformable ball = make_cloth(make_sphere(0.3, 20, 10), MeshClothOptions{});
    const Deformable sheet = make_cloth({.column_count = 5, .row_count = 5, .pose = {{}, {2, 0, 0}}});
    const Deformable body =
        make_soft_body(make_solid_box({0.2, 0.2, 0.2}, {2, 2, 2}), {.pose = {{}, {-2, 0, 0}}});
    SimulationOptions options;
    options.gravity = {};
    options.newton().pressure = 200;
    Simulation simulation(combine(std::vector{ball, sheet, body}), {}, options);
    for (int i = 0; i < 60; ++i) simulation.step();
    for (std::size_t i = 0; i < ball.particle_count(); ++i)
        EXPECT_GT(length(Vec3d(simulation.positions()[i])), 0.303);
    for (std::size_t i = ball.particle_count(); i < simulation.positions().size(); ++i)
        EXPECT_LT(length(simulation.positions()[i] - simulation.deformable().rest_positions[i]), 1e-5F);
}

TEST(Pressure, IsRefusedWhereNothingIsClosed) {
    expect_words(refusal(sheet_at(0, 1, 4), {}), "no piece of the cloth is closed");
    const Deformable body = make_soft_body(make_solid_box({1, 1, 1}, {1, 1, 1}), {});
    expect_words(refusal(body, {}), "no piece of the cloth is closed");
    const Deformable ball = make_cloth(make_sphere(0.3, 12, 8), MeshClothOptions{});
    EXPECT_EQ(refusal(ball, {}), "");
}
