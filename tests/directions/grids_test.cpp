#include "directions/cast_rays.hpp"
#include "directions/cube_grid.hpp"
#include "directions/face_cone.hpp"
#include "directions/octahedral_grid.hpp"
#include "directions/samples_near.hpp"
#include "directions/spherical_grid.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

TEST(EllipsoidalGrid, SpacesItsSamplesEvenlyByAngleInTheScaledFrame) {
    const Vec3f scale{1, 0.25F, 0.5F};
    const EllipsoidalGrid grid(16, 9, PoleAxis::X, scale);
    const std::vector<Vec3d> directions = grid.directions();
    for (std::uint32_t j = 0; j < 9; ++j)
        for (std::uint32_t i = 0; i < 16; ++i) {
            const double phi = 2 * std::numbers::pi * i / 16, theta = std::numbers::pi * (j + 0.5) / 9;
            // Poles on x: the grid's x, y, z are the mesh's y, z, x.
            const Vec3d g{std::cos(theta), std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi)};
            const Vec3d d = directions[grid.index(i, j)];
            EXPECT_NEAR(length(Vec3d{d.x, d.y / 4, d.z / 2} - g), 0, 1e-15);
            EXPECT_NEAR(grid.radial_norm(d), 1, 1e-15);
        }
}

TEST(EllipsoidalGrid, IsTheSphericalOneWhereNothingIsScaled) {
    const EllipsoidalGrid grid(20, 10, PoleAxis::Y, {1, 1, 1});
    const SphericalGrid sphere(20, 10, PoleAxis::Y);
    EXPECT_EQ(grid.directions(), sphere.directions());
    EXPECT_EQ(grid.largest_entry(3), sphere.largest_entry(3));
    test::Random random(1);
    for (int n = 0; n < 1000; ++n) {
        const Vec3f d = test::unit_vector(random);
        EXPECT_EQ(grid.locate(d).corners, sphere.locate(d).corners);
        EXPECT_EQ(EllipsoidalGrid::distance_of(2, grid.coordinates_of(d)), 2);
    }
}

TEST(EllipsoidalGrid, HoldsEveryRadialCoordinateInItsBox) {
    test::Random random(2);
    for (const Vec3f& half : {Vec3f{1, 1, 1}, Vec3f{1, 4, 2}, Vec3f{60, 1, 1}, Vec3f{1, 0.9F, 0.8F}}) {
        const float shortest = std::min({half.x, half.y, half.z});
        const EllipsoidalGrid grid(8, 4, PoleAxis::Z,
                                   {shortest / half.x, shortest / half.y, shortest / half.z});
        const float largest = grid.largest_entry(length(half) * (1 + 1e-7F)); // a radius is rounded up
        EXPECT_LE(grid.radial_norm(Vec3d(half)), static_cast<double>(largest));
        for (int n = 0; n < 1000; ++n)
            ASSERT_LE(grid.radial_norm(Vec3d(product(test::in_cube(random, 1), half))),
                      static_cast<double>(largest));
    }
}

TEST(EllipsoidalGrid, WeighsEachSampleByTheSolidAngleOfItsCell) {
    // The weights of an evenly scaled octant add up to an eighth, whatever the scale.
    const EllipsoidalGrid grid(400, 200, PoleAxis::Z, {0.2F, 1, 0.5F});
    const std::vector<double> weights = grid.solid_angle_weights();
    const std::vector<Vec3d> directions = grid.directions();
    double all = 0, narrow = 0;
    for (std::size_t d = 0; d < weights.size(); ++d) {
        all += weights[d];
        // A cone about x of 30 degrees takes (1 - cos 30) / 2 of the sphere.
        if (directions[d].x > length(directions[d]) * std::cos(std::numbers::pi / 6)) narrow += weights[d];
    }
    EXPECT_NEAR(narrow / all, (1 - std::cos(std::numbers::pi / 6)) / 2, 1e-3);
}

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

// Properties of every grid of directions.

namespace {

template <typename Grid>
Grid make(std::uint32_t resolution);

template <>
SphericalGrid make(std::uint32_t resolution) {
    return {4 * resolution, 2 * resolution, PoleAxis::Y};
}
template <>
OctahedralGrid make(std::uint32_t resolution) {
    return OctahedralGrid(resolution);
}
template <>
CubeGrid make(std::uint32_t resolution) {
    return CubeGrid(resolution);
}
template <>
EllipsoidalGrid make(std::uint32_t resolution) {
    return {4 * resolution, 2 * resolution, PoleAxis::X, {1, 0.125F, 0.5F}};
}

/// The box of a mesh that suits the ellipsoid's scale above.
const Vec3d kBoxSize{0.5, 4, 1};

/// Where a grid locates a direction: the weighted sum of its samples.
template <typename Grid>
Vec3d weighted_corners(const typename Grid::Cell& cell, const std::vector<Vec3d>& directions) {
    const std::array<float, 4> weights = Grid::weights(cell);
    Vec3d sum;
    for (std::size_t corner = 0; corner < 4; ++corner)
        sum += directions[cell.corners[corner]] * static_cast<double>(weights[corner]);
    return sum;
}

template <typename Grid>
Vec3d of_radial_norm_1(const Grid& grid, const Vec3d& d) {
    return d * (1 / grid.radial_norm(d));
}

/// Near planes of symmetry, edges of octahedra and cubes, poles and seams.
Vec3f direction_in_an_odd_place(test::Random& random, int n) {
    Vec3f d = test::unit_vector(random);
    if (n % 6 == 1) d.x *= 1e-4F;
    if (n % 6 == 2) d.y *= -1e-4F;
    if (n % 6 == 3) d.z *= 1e-4F;
    if (n % 6 == 4) d.x = d.y * (1 + 1e-6F * static_cast<float>(n % 7 - 3));
    if (n % 6 == 5) d.z = -d.x;
    return d;
}

template <typename Grid>
class EveryGrid : public testing::Test {};

using Grids = testing::Types<SphericalGrid, OctahedralGrid, CubeGrid, EllipsoidalGrid>;
TYPED_TEST_SUITE(EveryGrid, Grids);

/// Expects that a face's search visits each sample in its cone once. @return how many these are
template <typename Grid>
int samples_visited_once(const Grid& grid, const std::vector<LatticePoint>& directions,
                         const std::array<LatticePoint, 3>& face) {
    const FaceCone cone(face[0], face[1], face[2]);
    if (cone.edge_on()) return 0;
    std::vector<int> visits(directions.size());
    for_each_sample_near(grid, face, 0, [&](std::uint32_t sample) { ++visits[sample]; });
    int met = 0;
    for (std::size_t d = 0; d < directions.size(); ++d) {
        EXPECT_LE(visits[d], 1) << d;
        if (!cone.meets(directions[d])) continue;
        EXPECT_EQ(visits[d], 1) << d;
        ++met;
    }
    return met;
}

} // namespace

TYPED_TEST(EveryGrid, LocatesADirectionAmongItsNeighbours) {
    test::Random random(1);
    for (const std::uint32_t resolution : {4U, 7U, 64U}) {
        const TypeParam grid = make<TypeParam>(resolution);
        const std::vector<Vec3d> directions = grid.directions();
        // A chord is shorter than its arc by the square of a cell, which is widest along the longer axes of a
        // scaled frame; near a pole, samples from half the circle surround a direction.
        const double cell = std::numbers::pi / 2 / resolution;
        const double widest = std::is_same_v<TypeParam, EllipsoidalGrid> ? 8 : 1;
        for (int n = 0; n < 20'000; ++n) {
            const Vec3f d = direction_in_an_odd_place(random, n);
            const auto at = grid.locate(grid.to_grid(d));
            float total = 0;
            for (const float weight : TypeParam::weights(at)) {
                ASSERT_GE(weight, 0);
                total += weight;
            }
            ASSERT_NEAR(total, 1, 1e-6);
            const Vec3d found = weighted_corners<TypeParam>(at, directions);
            ASSERT_LT(length(found - of_radial_norm_1(grid, Vec3d(d))), widest * (cell * cell + 2e-6)) << n;
        }
    }
}

TYPED_TEST(EveryGrid, LocatesEachOfItsSamplesAtItself) {
    const TypeParam grid = make<TypeParam>(12);
    const std::vector<Vec3d> directions = grid.directions();
    for (const Vec3d& d : directions) {
        const auto at = grid.locate(grid.to_grid(Vec3f(d)));
        ASSERT_LT(length(weighted_corners<TypeParam>(at, directions) - d), 2e-5);
        ASSERT_LT(length(directions[at.corners[TypeParam::reference_corner(at)]] - d), 1e-6);
    }
}

TYPED_TEST(EveryGrid, TakesASampleWithTheLargestWeightAsTheReference) {
    test::Random random(2);
    const TypeParam grid = make<TypeParam>(9);
    for (int n = 0; n < 10'000; ++n) {
        const auto at = grid.locate(direction_in_an_odd_place(random, n));
        const std::array<float, 4> weights = TypeParam::weights(at);
        const std::size_t reference = TypeParam::reference_corner(at);
        for (const float weight : weights) ASSERT_LE(weight, weights[reference]);
        ASSERT_TRUE(TypeParam::is_sample(at, reference));
        for (std::size_t corner = 0; corner < 4; ++corner)
            if (!TypeParam::is_sample(at, corner)) ASSERT_EQ(weights[corner], 0);
    }
}

TYPED_TEST(EveryGrid, StaysInRangeAtTheCentreOnCoordinatePlanesAndFarAway) {
    const TypeParam grid = make<TypeParam>(5);
    for (float x : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F})
        for (float y : {0.0F, -0.0F, 1.0F, -1.0F, -1e-30F, 1e18F})
            for (float z : {0.0F, -0.0F, 1.0F, -1.0F, 1e-30F, -1e18F}) {
                const auto at = grid.locate({x, y, z});
                for (std::uint32_t corner : at.corners) ASSERT_LT(corner, grid.direction_count());
                ASSERT_TRUE(at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1);
            }
}

TYPED_TEST(EveryGrid, VisitsAllSamplesInTheConeOfAFaceEachOnce) {
    test::Random random(3);
    for (const std::uint32_t resolution : {4U, 11U}) {
        const TypeParam grid = make<TypeParam>(resolution);
        const std::vector<LatticePoint> directions = grid.lattice_directions();
        int met = 0;
        for (int n = 0; n < 3000; ++n) {
            std::array<LatticePoint, 3> face;
            const float size = n % 3 == 0 ? 1 : 0.2F; // large ones span sides
            const Vec3f middle = test::unit_vector(random);
            for (LatticePoint& corner : face)
                corner = lattice_direction(Vec3d(middle + test::in_cube(random, size)) * 0.4);
            // Corners on samples, edges along planes of symmetry.
            if (n % 5 == 0) face[0] = directions[static_cast<std::size_t>(n) % directions.size()];
            met += samples_visited_once(grid, directions, face);
        }
        EXPECT_GT(met, 1000);
    }
}

TYPED_TEST(EveryGrid, VisitsAllSamplesInTheConeOfAFaceThatAllButTouchesTheOrigin) {
    // A millionth of a lattice step away: as its corners are seen there, it fills half of all directions.
    constexpr std::array<std::int64_t, 5> kPlaces{-370'725, -1, 0, 1, 370'726};
    test::Random random(4);
    const auto corner = [&] {
        const auto place = [&] { return kPlaces[random() % kPlaces.size()]; };
        return LatticePoint{place(), place(), place()};
    };
    const TypeParam grid = make<TypeParam>(4);
    const std::vector<LatticePoint> directions = grid.lattice_directions();
    int met = 0;
    for (int n = 0; n < 20'000; ++n) {
        const std::array<LatticePoint, 3> face{corner(), corner(), corner()};
        met += samples_visited_once(grid, directions, face);
    }
    EXPECT_GT(met, 1000);
}

TYPED_TEST(EveryGrid, CrossesABoxOnItsSides) {
    const TypeParam grid = make<TypeParam>(16);
    const Crossings crossings = cast_rays(snap_to_lattice(make_box(kBoxSize)), grid, 0);
    const std::vector<Vec3d> directions = grid.directions();
    ASSERT_EQ(crossings.distances.size(), directions.size());
    for (std::size_t d = 0; d < directions.size(); ++d) {
        const Vec3d p = directions[d] * (2 * static_cast<double>(crossings.distances[d]));
        EXPECT_NEAR(
            std::max({std::fabs(p.x) / kBoxSize.x, std::fabs(p.y) / kBoxSize.y, std::fabs(p.z) / kBoxSize.z}),
            1, 1e-4);
    }
}

TYPED_TEST(EveryGrid, CrossesAMeshInTheSamePlacesOnAnyNumberOfThreads) {
    TriangleMesh torus = make_torus(1, 0.4, 40, 20);
    for (Vec3f& v : torus.vertices) v = {v.x / 8, v.y, v.z * 0.875F};
    const LatticeMesh lattice = snap_to_lattice(torus);
    const TypeParam grid = make<TypeParam>(20);
    const Crossings one = cast_rays(lattice, grid, 1);
    const Crossings many = cast_rays(lattice, grid, 3);
    EXPECT_EQ(one.offsets, many.offsets);
    EXPECT_EQ(one.distances, many.distances);
    for (std::size_t d = 0; d + 1 < one.offsets.size(); ++d)
        EXPECT_EQ((one.offsets[d + 1] - one.offsets[d]) % 2, 0U); // the centre lies outside
    for (const float distance : one.distances)
        EXPECT_TRUE(distance >= 0 && distance <= grid.largest_entry(lattice.radius));
}
