#include "directions/ellipsoidal_grid.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace echinus;

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
