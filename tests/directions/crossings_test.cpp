#include "directions/crossings.hpp"
#include "support/mesh_assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;
using test::joined;
using test::translated;

TEST(Crossings, HaveTheParityOfTheCentreOnEveryRayOfAClosedMesh) {
    // Meshes and grids share planes of symmetry, so that many rays meet edges and vertices.
    const struct {
        TriangleMesh mesh;
        std::uint32_t parity;
    } cases[] = {
        {make_box({2, 2, 2}, 4), 1},
        {make_sphere(1, 40, 20), 1},
        {make_torus(1, 0.4, 60, 24), 0},
        {joined({make_box({4, 4, 4}, 2), make_box({1, 1, 1}, 2)}), 0},
        {joined({translated(make_box({1, 1, 1}), {2, 0, 0}), translated(make_box({1, 1, 1}), {-2, 0, 0})}),
         0},
    };
    for (const auto& [mesh, parity] : cases)
        for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
            const SphericalGrid grid(80, 40, axis);
            const Crossings crossings = cast_rays(snap_to_lattice(mesh), grid, 1);
            for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d)
                ASSERT_EQ((crossings.offsets[d + 1] - crossings.offsets[d]) % 2, parity) << "direction " << d;
        }
}

TEST(Crossings, OfABoxLieOnItsSides) {
    const SphericalGrid grid(50, 30, PoleAxis::Z);
    const Crossings crossings = cast_rays(snap_to_lattice(make_box({2, 2, 2})), grid, 0);
    std::size_t index = 0;
    for (const Vec3d& d : grid.directions()) {
        const double expected = 1 / std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        ASSERT_EQ(crossings.offsets[index + 1] - crossings.offsets[index], 1U);
        ASSERT_NEAR(crossings.distances[crossings.offsets[index]], expected, 1e-5);
        ++index;
    }
}

TEST(Crossings, AreTheSameForEveryNumberOfThreads) {
    const LatticeMesh lattice = snap_to_lattice(make_torus(1, 0.4, 120, 48));
    const SphericalGrid grid(100, 100, PoleAxis::X);
    const Crossings one = cast_rays(lattice, grid, 1);
    for (unsigned thread_count : {0U, 2U, 5U}) {
        const Crossings many = cast_rays(lattice, grid, thread_count);
        EXPECT_EQ(many.offsets, one.offsets);
        EXPECT_EQ(many.distances, one.distances);
    }
}

TEST(Crossings, StayInTheSphereAndAscend) {
    const LatticeMesh lattice = snap_to_lattice(make_torus(1, 0.4, 60, 24));
    const Crossings crossings = cast_rays(lattice, SphericalGrid(90, 45, PoleAxis::Y), 0);
    for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d) {
        const auto first = crossings.distances.begin() + crossings.offsets[d];
        const auto last = crossings.distances.begin() + crossings.offsets[d + 1];
        EXPECT_TRUE(std::is_sorted(first, last));
    }
    for (float distance : crossings.distances) EXPECT_TRUE(distance >= 0 && distance <= lattice.radius);
}
