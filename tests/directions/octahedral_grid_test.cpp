#include "directions/octahedral_grid.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

/// The point of the octahedron that a cell's weights define.
Vec3d weighted_corners(const OctahedralGrid::Cell& cell, const std::vector<Vec3d>& directions) {
    const std::array<float, 4> weights = OctahedralGrid::weights(cell);
    Vec3d sum;
    for (std::size_t corner = 0; corner < 4; ++corner)
        sum += directions[cell.corners[corner]] * static_cast<double>(weights[corner]);
    return sum;
}

} // namespace

TEST(OctahedralGrid, HasItsSamplesOnTheOctahedron) {
    const OctahedralGrid grid(6);
    for (const Vec3d& d : grid.directions()) EXPECT_NEAR(OctahedralGrid::radial_norm(d), 1, 1e-15);
    for (std::uint32_t row = 0; row < grid.width(); ++row)
        for (std::uint32_t column = 0; column < grid.width(); ++column) {
            const std::uint32_t same = grid.canonical(column, row);
            EXPECT_EQ(grid.sample(column, row), grid.sample(same % grid.width(), same / grid.width()));
        }
}

TEST(OctahedralGrid, LocatesADirectionInTheTriangleAroundIt) {
    test::Random random(1);
    for (std::uint32_t divisions : {4U, 7U, 64U}) {
        const OctahedralGrid grid(divisions);
        const std::vector<Vec3d> directions = grid.directions();
        for (int n = 0; n < 20'000; ++n) {
            Vec3f d = test::unit_vector(random);
            if (n % 4 == 1) d.x *= 1e-4F; // next to the edges of the octahedron
            if (n % 4 == 2) d.y *= -1e-4F;
            if (n % 4 == 3) d.z *= 1e-4F;
            const OctahedralGrid::Cell cell = grid.locate(d);
            const Vec3d on_octahedron = Vec3d(d) * (1 / OctahedralGrid::radial_norm(Vec3d(d)));
            ASSERT_LT(length(weighted_corners(cell, directions) - on_octahedron), 2e-6) << n;
            for (float weight : OctahedralGrid::weights(cell)) ASSERT_GE(weight, 0);
            for (std::uint32_t corner : cell.corners)
                ASSERT_LT(OctahedralGrid::radial_norm(directions[corner] - on_octahedron),
                          2.0 / divisions + 1e-5);
        }
    }
}
