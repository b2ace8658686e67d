#include "render/corner_normals.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

TEST(CornerNormals, KeepTheEdgesOfABoxSharp) {
    const TriangleMesh box = make_box({1, 2, 3});
    const auto normals = corner_normals(box, 40);
    for (std::size_t f = 0; f < box.faces.size(); ++f) {
        for (const Vec3f& normal : normals[f]) {
            EXPECT_NEAR(length(Vec3d(normal) - face_normal(box, box.faces[f])), 0, 1e-6);
        }
    }
}

TEST(CornerNormals, PointAlongTheDiagonalsWhereABoxIsSmoothed) {
    // Weighted by angle, each of the three sides counts as a right angle, however its square is split.
    const TriangleMesh box = make_box({1, 1, 1});
    const auto normals = corner_normals(box, 180);
    for (std::size_t f = 0; f < box.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3d corner(box.vertices[box.faces[f][k]]);
            EXPECT_NEAR(length(Vec3d(normals[f][k]) - corner * (1 / length(corner))), 0, 1e-5);
        }
    }
}

TEST(CornerNormals, AreNearlyRadialOnASphere) {
    const TriangleMesh sphere = make_sphere(2, 48, 24);
    const auto normals = corner_normals(sphere, 40);
    for (std::size_t f = 0; f < sphere.faces.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_GT(dot(normals[f][k], sphere.vertices[sphere.faces[f][k]] * 0.5F), 0.999F);
        }
    }
}

TEST(CornerNormals, AreZeroOnAFaceWithoutArea) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(corner_normals(mesh, 40)[0][1], Vec3f{});
}
