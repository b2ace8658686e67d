#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace echinus;
using test::joined;
using test::translated;
using test::turned_inside_out;

namespace {

/// |x| + |y| + |z| = 2^19: its bounding radius makes the lattice step 1, so that lattice points are whole
/// numbers.
TriangleMesh lattice_octahedron() {
    TriangleMesh mesh;
    const float r = 1 << 19;
    mesh.vertices = {{r, 0, 0}, {-r, 0, 0}, {0, r, 0}, {0, -r, 0}, {0, 0, r}, {0, 0, -r}};
    mesh.faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

} // namespace

TEST(ExactMapContains, DecidesToTheLastLatticeStep) {
    for (std::uint32_t divisions : {1U, 4U, 24U}) {
        const ExactMap map = ExactMap::build(lattice_octahedron(), {.divisions = divisions});
        ASSERT_EQ(map.view().radius, 524'288.0F);
        test::Random random(divisions);
        std::uniform_int_distribution<int> share(0, 1 << 19);
        for (int n = 0; n < 20'000; ++n) {
            // A point of the face x + y + z = 2^19, and its neighbours one step in and out.
            const int x = share(random);
            const int y = n % 3 == 0 ? 0 : n % 3 == 1 ? (1 << 19) - x : share(random) % ((1 << 19) - x + 1);
            const int z = (1 << 19) - x - y;
            const Vec3f mirror{n & 1 ? 1.0F : -1.0F, n & 2 ? 1.0F : -1.0F, n & 4 ? 1.0F : -1.0F};
            const auto at = [&](int step) {
                const int k = x >= y && x >= z ? 0 : y >= z ? 1 : 2; // move the largest coordinate
                return Vec3f{mirror.x * static_cast<float>(x + (k == 0 ? step : 0)),
                             mirror.y * static_cast<float>(y + (k == 1 ? step : 0)),
                             mirror.z * static_cast<float>(z + (k == 2 ? step : 0))};
            };
            ASSERT_TRUE(contains(map, at(-1))) << x << " " << y << " " << z;
            ASSERT_FALSE(contains(map, at(1))) << x << " " << y << " " << z;
        }
    }
}

TEST(ExactMapContains, AgreesWithTheWindingNumber) {
    const TriangleMesh sphere = make_sphere(1, 24, 12);
    const TriangleMesh small = make_sphere(0.5, 16, 8);
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    const TriangleMesh meshes[] = {
        make_torus(1, 0.4, 30, 12),
        make_box({2, 1, 0.5}, 3),
        joined({sphere, small}),                               // nested
        joined({sphere, turned_inside_out(small)}),            // a cavity
        joined({box, translated(box, {0.5F, 0.25F, 0.125F})}), // overlapping
        joined({translated(box, {3, 0, 0}), translated(box, {-3, 0, 0})}),
        turned_inside_out(sphere),
        joined({box, box}),
        make_box({1, 1e-4, 1e-4}),
        test::make_two_wedges(),
        test::make_four_wedges(),
        test::make_open_mouth(),
    };
    test::Random random(1);
    for (const TriangleMesh& mesh : meshes)
        for (InsideRule rule : {InsideRule::Nonzero, InsideRule::Parity})
            for (std::uint32_t divisions : {0U, 1U, 9U}) {
                const ExactMap map = ExactMap::build(mesh, {.divisions = divisions, .rule = rule});
                for (int n = 0; n < 2000; ++n) {
                    const Vec3f p = test::in_sphere(random, 1.2F * map.view().radius);
                    const int winding = static_cast<int>(std::lround(winding_number(mesh, Vec3d(p))));
                    const bool expected = rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
                    if (contains(map, p) != expected)
                        ASSERT_LT(unsigned_distance(mesh, Vec3d(p)), 4e-6 * map.view().radius);
                }
            }
}

TEST(ExactMapContains, AnswersTheSameForEveryResolution) {
    // Points on the lattice of the mesh's own coordinates: many lie on faces, edges, vertices and walls of
    // cells.
    const TriangleMesh mesh = joined({make_box({2, 2, 2}, 4), translated(make_box({2, 2, 2}, 2), {1, 1, 1})});
    const ExactMap coarse = ExactMap::build(mesh, {.divisions = 1});
    for (std::uint32_t divisions : {2U, 5U, 32U}) {
        const ExactMap fine = ExactMap::build(mesh, {.divisions = divisions});
        for (int x = -10; x <= 20; ++x)
            for (int y = -10; y <= 20; ++y)
                for (int z = -10; z <= 20; ++z) {
                    const Vec3f p = Vec3f(Vec3d(double(x), double(y), double(z)) * 0.125);
                    ASSERT_EQ(contains(coarse, p), contains(fine, p)) << x << " " << y << " " << z;
                }
    }
}

TEST(ExactMapContains, IsRightWhereTheCentreLiesOnTheSurface) {
    // Two boxes that touch at the centre of their bounding sphere: with a corner, along an edge, with a side.
    const TriangleMesh box = make_box({2, 2, 2});
    for (const Vec3f& offset : {Vec3f{1, 1, 1}, Vec3f{1, 1, 0}, Vec3f{1, 0, 0}}) {
        const TriangleMesh mesh = joined({translated(box, offset), translated(box, -offset)});
        const ExactMap map = ExactMap::build(mesh);
        test::Random random(2);
        for (int n = 0; n < 5000; ++n) {
            const Vec3f p = test::in_sphere(random, n % 2 == 0 ? 3.0F : 0.01F);
            const bool expected = std::abs(winding_number(mesh, Vec3d(p))) > 0.5;
            if (contains(map, p) != expected) ASSERT_LT(unsigned_distance(mesh, Vec3d(p)), 2e-5);
        }
    }
}

TEST(ExactMapContains, TreatsNaNAndInfinityAsOutside) {
    const ExactMap map = ExactMap::build(make_box({2, 2, 2}));
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                      -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()})
        for (const Vec3f& p : {Vec3f{bad, 0, 0}, Vec3f{0, bad, 0}, Vec3f{0, 0, bad}})
            EXPECT_FALSE(contains(map, p));
    EXPECT_TRUE(contains(map, map.view().centre));
}
