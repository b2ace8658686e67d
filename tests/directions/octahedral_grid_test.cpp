#include "directions/crossing.hpp"
#include "directions/crossings.hpp"
#include "directions/octahedral_grid.hpp"
#include "directions/octahedral_samples.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

/// The point of the octahedron that a cell's weights stand for.
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

TEST(OctahedralGrid, LocatesEachOfItsSamplesAtItself) {
    const OctahedralGrid grid(12);
    const std::vector<Vec3d> directions = grid.directions();
    for (const Vec3d& d : directions)
        ASSERT_LT(length(weighted_corners(grid.locate(Vec3f(d)), directions) - d), 1e-6);
}

TEST(OctahedralGrid, StaysInRangeAtTheCentreAndOnCoordinatePlanes) {
    const OctahedralGrid grid(5);
    for (float x : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F})
        for (float y : {0.0F, -0.0F, 1.0F, -1.0F, -1e-30F, 1e18F})
            for (float z : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F}) {
                const OctahedralGrid::Cell cell = grid.locate({x, y, z});
                for (std::uint32_t corner : cell.corners) ASSERT_LT(corner, grid.direction_count());
            }
}

TEST(OctahedralGrid, TakesTheWeightiestCornerForTheReferenceAndNeverTheOneThatIsNone) {
    test::Random random(2);
    const OctahedralGrid grid(9);
    for (int n = 0; n < 10'000; ++n) {
        const OctahedralGrid::Cell cell = grid.locate(test::unit_vector(random));
        const std::array<float, 4> weights = OctahedralGrid::weights(cell);
        const std::size_t reference = OctahedralGrid::reference_corner(cell);
        for (float weight : weights) ASSERT_LE(weight, weights[reference]);
        ASSERT_TRUE(OctahedralGrid::is_sample(cell, reference));
        ASSERT_EQ(weights[cell.doubled()], 0);
    }
}

TEST(OctahedralSamples, NearAFaceAreAllInItsConeAndEachOnce) {
    test::Random random(3);
    for (std::uint32_t divisions : {4U, 11U}) {
        const OctahedralGrid grid(divisions);
        const std::vector<LatticePoint> directions = grid.lattice_directions();
        int met = 0;
        for (int n = 0; n < 3000; ++n) {
            std::array<LatticePoint, 3> face;
            const float size = n % 3 == 0 ? 1 : 0.2F; // large ones span octants
            const Vec3f middle = test::unit_vector(random);
            for (LatticePoint& corner : face)
                corner = lattice_direction(Vec3d(middle + test::in_cube(random, size)) * 0.4);
            // Corners on samples, edges along octants.
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

TEST(OctahedralCrossings, OfABoxLieOnItsSides) {
    const OctahedralGrid grid(16);
    const Crossings crossings = cast_rays(snap_to_lattice(make_box({2, 2, 2})), grid, 0);
    const std::vector<Vec3d> directions = grid.directions();
    ASSERT_EQ(crossings.distances.size(), directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d) {
        const Vec3d p = directions[d] * static_cast<double>(crossings.distances[d]);
        EXPECT_NEAR(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 1, 1e-5);
    }
}

TEST(OctahedralCrossings, DoNotDependOnTheNumberOfThreads) {
    const LatticeMesh lattice = snap_to_lattice(make_torus(1, 0.4, 40, 20));
    const OctahedralGrid grid(20);
    const Crossings one = cast_rays(lattice, grid, 1);
    const Crossings many = cast_rays(lattice, grid, 3);
    EXPECT_EQ(one.offsets, many.offsets);
    EXPECT_EQ(one.distances, many.distances);
    for (std::size_t d = 0; d + 1 < one.offsets.size(); ++d)
        EXPECT_EQ((one.offsets[d + 1] - one.offsets[d]) % 2, 0U); // the centre lies outside
}
