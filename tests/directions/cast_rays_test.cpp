#include "directions/cast_rays.hpp"
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
