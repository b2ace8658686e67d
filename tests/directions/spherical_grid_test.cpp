#include "directions/spherical_grid.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <set>

using namespace echinus;

namespace {

const SphericalGrid kGrids[] = {{200, 200, PoleAxis::Z}, {16, 9, PoleAxis::X}, {7, 4, PoleAxis::Y}};

float corner_weight(const SphericalGrid::Cell& cell, int corner) {
    return (corner & 1 ? cell.u : 1 - cell.u) * (corner & 2 ? cell.v : 1 - cell.v);
}

} // namespace

TEST(SphericalGrid, LocatesEachOfItsSamplesAtItself) {
    for (const SphericalGrid& grid : kGrids) {
        const std::vector<Vec3d> directions = grid.directions();
        for (std::uint32_t j = 0; j < grid.colatitude_count(); ++j)
            for (std::uint32_t i = 0; i < grid.longitude_count(); ++i) {
                const auto cell = grid.locate(grid.to_grid(Vec3f(directions[grid.index(i, j)])));
                float weight = 0;
                for (int corner = 0; corner < 4; ++corner)
                    if (cell.corners[static_cast<std::size_t>(corner)] == grid.index(i, j))
                        weight += corner_weight(cell, corner);
                ASSERT_NEAR(weight, 1, 1e-3) << i << ", " << j;
            }
    }
}

TEST(SphericalGrid, CornersOfACellLieAroundTheDirection) {
    test::Random random(1);
    const SphericalGrid grid(64, 32, PoleAxis::Y);
    const std::vector<Vec3d> directions = grid.directions();
    for (int n = 0; n < 20'000; ++n) {
        const Vec3f d = test::unit_vector(random);
        const auto cell = grid.locate(grid.to_grid(d));
        for (std::uint32_t corner : cell.corners) {
            ASSERT_GT(dot(directions[corner], Vec3d(d)),
                      std::cos(0.15)); // the diagonal of a cell is 0.139 rad
        }
    }
}

TEST(SphericalGrid, HasFourDifferentCornersInEveryCell) {
    test::Random random(2);
    const SphericalGrid grid(8, 4, PoleAxis::Z);
    for (int n = 0; n < 20'000; ++n) {
        const auto cell = grid.locate(test::unit_vector(random));
        ASSERT_EQ(std::set<std::uint32_t>(cell.corners.begin(), cell.corners.end()).size(), 4U);
    }
}

TEST(SphericalGrid, CrossesAPoleToTheOppositeLongitude) {
    const SphericalGrid grid(8, 4, PoleAxis::Z);
    const auto cell = grid.locate({0.01F, 0.0F, 1});
    EXPECT_EQ(cell.corners[0], grid.index(4, 0)); // beyond the pole
    EXPECT_EQ(cell.corners[2], grid.index(0, 0));
}
