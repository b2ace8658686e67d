#include "directions/crossing.hpp"
#include "directions/crossings.hpp"
#include "directions/cube_grid.hpp"
#include "directions/cube_samples.hpp"
#include "support/random_points.hpp"

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

TEST(CubeGrid, HasItsSamplesEvenlyByAngleAlongEachSide) {
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
    EXPECT_EQ(distinct.size(), 6U * 5 * 5 + 2); // as many as a cube of 5 x 5 x 5 has on its surface
}

TEST(CubeGrid, LocatesADirectionAmongItsNeighbours) {
    test::Random random(1);
    for (std::uint32_t divisions : {4U, 7U, 64U}) {
        const CubeGrid grid(divisions);
        const std::vector<Vec3d> directions = grid.directions();
        for (int n = 0; n < 20'000; ++n) {
            Vec3f d = test::unit_vector(random);
            if (n % 4 == 1) d.x = d.y * (1 + 1e-6F * static_cast<float>(n % 7 - 3)); // about the edges
            if (n % 4 == 2) d.z = -d.x;
            const CubeGrid::Cell cell = grid.locate(d);
            const std::array<float, 4> weights = CubeGrid::weights(cell);
            Vec3d sum;
            float total = 0;
            for (std::size_t corner = 0; corner < 4; ++corner) {
                ASSERT_GE(weights[corner], 0);
                total += weights[corner];
                sum += directions[cell.corners[corner]] * static_cast<double>(weights[corner]);
            }
            ASSERT_NEAR(total, 1, 1e-6);
            // A chord is shorter than its arc by the square of a cell.
            const double cell_size = std::numbers::pi / 2 / divisions;
            ASSERT_LT(length(sum - Vec3d(d) * (1 / length(Vec3d(d)))), cell_size * cell_size + 1e-6) << n;
        }
    }
}

TEST(CubeGrid, LocatesEachOfItsSamplesAtItself) {
    const CubeGrid grid(12);
    const std::vector<Vec3d> directions = grid.directions();
    for (const Vec3d& d : directions) {
        const CubeGrid::Cell cell = grid.locate(Vec3f(d));
        const std::uint32_t nearest = cell.corners[CubeGrid::reference_corner(cell)];
        ASSERT_LT(length(directions[nearest] - d), 1e-6);
    }
}

TEST(CubeGrid, StaysInRangeAtTheCentreAndOnCoordinatePlanes) {
    const CubeGrid grid(5);
    for (float x : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F})
        for (float y : {0.0F, -0.0F, 1.0F, -1.0F, -1e-30F, 1e18F})
            for (float z : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F}) {
                const CubeGrid::Cell cell = grid.locate({x, y, z});
                for (std::uint32_t corner : cell.corners) ASSERT_LT(corner, grid.direction_count());
            }
}

TEST(CubeGrid, SharesOutTheWholeSphereBySolidAngle) {
    const CubeGrid grid(40);
    double sum = 0;
    for (const double weight : grid.solid_angle_weights()) sum += weight;
    const double cell = std::numbers::pi / 2 / 40;
    EXPECT_NEAR(sum * cell * cell, 4 * std::numbers::pi, 0.01);
}

TEST(CubeSamples, NearAFaceAreAllInItsConeAndEachOnce) {
    test::Random random(3);
    for (std::uint32_t divisions : {4U, 11U}) {
        const CubeGrid grid(divisions);
        const std::vector<LatticePoint> directions = grid.lattice_directions();
        int met = 0;
        for (int n = 0; n < 3000; ++n) {
            std::array<LatticePoint, 3> face;
            const float size = n % 3 == 0 ? 1 : 0.2F; // large ones span sides
            const Vec3f middle = test::unit_vector(random);
            for (LatticePoint& corner : face)
                corner = lattice_direction(Vec3d(middle + test::in_cube(random, size)) * 0.4);
            if (n % 5 == 0) face[0] = directions[static_cast<std::size_t>(n) % directions.size()];
            const FaceCone cone(face[0], face[1], face[2]);
            if (cone.edge_on()) continue;
            std::vector<int> visits(directions.size());
            for_each_sample_near(grid, face, 0, [&](std::uint32_t sample) { ++visits[sample]; });
            for (std::size_t d = 0; d < directions.size(); ++d) {
                ASSERT_LE(visits[d], 1);
                if (!cone.meets(directions[d])) continue;
                ASSERT_EQ(visits[d], 1) << n << ' ' << d;
                ++met;
            }
        }
        EXPECT_GT(met, 1000);
    }
}

TEST(CubeCrossings, OfABoxLieOnItsSides) {
    const CubeGrid grid(16);
    const Crossings crossings = cast_rays(snap_to_lattice(make_box({2, 2, 2})), grid, 0);
    const std::vector<Vec3d> directions = grid.directions();
    ASSERT_EQ(crossings.distances.size(), directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d)
        EXPECT_NEAR(along_cube(directions[d] * static_cast<double>(crossings.distances[d])), 1, 1e-5);
}
