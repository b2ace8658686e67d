#include "directions/cube_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

using namespace echinus;

namespace {

float along_cube(const Vec3d& d) {
    return static_cast<float>(std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)}));
}

} // namespace

TEST(CubeGrid, SpacesItsSamplesEvenlyByAngleAlongEachSide) {
    const std::uint32_t n = 6;
    const CubeGrid grid(n);
    const std::vector<Vec3d> directions = grid.directions();
    ASSERT_EQ(directions.size(), grid.direction_count());
    const std::array<Vec3d, 6> outward{Vec3d{1, 0, 0},  Vec3d{-1, 0, 0}, Vec3d{0, 1, 0},
                                       Vec3d{0, -1, 0}, Vec3d{0, 0, 1},  Vec3d{0, 0, -1}};
    for (std::uint32_t side = 0; side < 6; ++side)
        for (std::uint32_t j = 0; j <= n; ++j)
            for (std::uint32_t i = 0; i <= n; ++i) {
                const Vec3d d = directions[grid.index(side, i, j)];
                EXPECT_NEAR(length(d), 1, 1e-15);
                EXPECT_NEAR(dot(d, outward[side]), along_cube(d), 1e-7);
                const Vec3d s = CubeGrid::to_side(side, d);
                const double angle = std::numbers::pi / 4 * (2.0 * i / n - 1);
                EXPECT_NEAR(std::atan2(s.x, std::fabs(s.z)), angle, 1e-14);
            }
}

TEST(CubeGrid, GivesSamplesOfOneDirectionTheSameBitsAndOneCanonicalIndex) {
    const CubeGrid grid(5);
    const std::vector<Vec3d> directions = grid.directions();
    std::set<std::uint32_t> distinct;
    for (std::uint32_t side = 0; side < 6; ++side)
        for (std::uint32_t j = 0; j <= 5; ++j)
            for (std::uint32_t i = 0; i <= 5; ++i) {
                const std::uint32_t same = grid.canonical(side, i, j);
                EXPECT_EQ(directions[grid.index(side, i, j)], directions[same]);
                distinct.insert(same);
            }
    EXPECT_EQ(distinct.size(), 6U * 5 * 5 + 2); // the surface points of a cube of 5 x 5 x 5 cells
}

TEST(CubeGrid, SharesOutTheWholeSphereBySolidAngle) {
    const CubeGrid grid(40);
    double sum = 0;
    for (const double weight : grid.solid_angle_weights()) sum += weight;
    const double cell = std::numbers::pi / 2 / 40;
    EXPECT_NEAR(sum * cell * cell, 4 * std::numbers::pi, 0.01);
}
