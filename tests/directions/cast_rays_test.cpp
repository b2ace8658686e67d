#include "directions/cast_rays.hpp"
#include "directions/face_cone.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace echinus;
using test::joined;
using test::translated;

namespace {

using Faces = std::vector<std::array<LatticePoint, 3>>;

/// |x| + |y| + |z| = r around `middle`, outward. Its edges lie in the coordinate planes, its vertices on the
/// axes.
Faces octahedron(std::int64_t r, const LatticePoint& middle) {
    Faces faces;
    for (std::int64_t sx : {-r, r})
        for (std::int64_t sy : {-r, r})
            for (std::int64_t sz : {-r, r}) {
                const LatticePoint x{middle.x + sx, middle.y, middle.z}, y{middle.x, middle.y + sy, middle.z},
                    z{middle.x, middle.y, middle.z + sz};
                const bool even = ((sx < 0) + (sy < 0) + (sz < 0)) % 2 == 0;
                if (even)
                    faces.push_back({x, y, z});
                else
                    faces.push_back({y, x, z});
            }
    return faces;
}

struct Count {
    int all = 0, outward = 0;
};

Count crossings(const Faces& faces, const LatticePoint& d) {
    Count count;
    for (const auto& [a, b, c] : faces) {
        const FaceCone cone(a, b, c);
        if (cone.edge_on() || !cone.meets(d)) continue;
        ++count.all;
        count.outward += cone.outward();
    }
    return count;
}

} // namespace

TEST(Crossing, RaysThroughVerticesAndEdgesLeaveAConvexSolidOnce) {
    const Faces faces = octahedron(1000, {});
    for (std::int64_t x = -3; x <= 3; ++x)
        for (std::int64_t y = -3; y <= 3; ++y)
            for (std::int64_t z = -3; z <= 3; ++z) {
                if (x == 0 && y == 0 && z == 0) continue;
                const Count count = crossings(faces, {x, y, z});
                EXPECT_EQ(count.all, 1) << x << " " << y << " " << z;
                EXPECT_EQ(count.outward, 1);
            }
}

TEST(Crossing, RaysFromOutsideEnterAsOftenAsTheyLeave) {
    // The origin lies in the plane of four of the edges and is seen along the faces' symmetry planes.
    const Faces faces = octahedron(4, {6, 0, 0});
    for (std::int64_t x = -12; x <= 12; ++x)
        for (std::int64_t y = -12; y <= 12; ++y)
            for (std::int64_t z = -12; z <= 12; ++z) {
                const Count count = crossings(faces, {x, y, z});
                EXPECT_EQ(count.all, 2 * count.outward) << x << " " << y << " " << z;
            }
}

TEST(Crossing, DecidesRightAtTheLimitsOfTheLattice) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<std::int64_t> coordinate(-kLatticeExtent, kLatticeExtent);
    const Faces faces = octahedron(kLatticeExtent, {});
    for (int n = 0; n < 20'000; ++n) {
        const LatticePoint d{coordinate(random), coordinate(random), coordinate(random)};
        ASSERT_EQ(crossings(faces, d).all, 1);
    }
}

TEST(Crossing, ParameterIsThePlanesDistanceAlongTheRay) {
    const FaceCone cone({0, 0, 10}, {100, 0, 10}, {0, 100, 10});
    ASSERT_TRUE(cone.outward());
    ASSERT_TRUE(cone.meets({3, 3, 4}));
    EXPECT_DOUBLE_EQ(cone.parameter({3, 3, 4}), 2.5);
}

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
