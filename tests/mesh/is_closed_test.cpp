#include "mesh/is_closed.hpp"
#include "support/mesh_assembly.hpp"

#include <gtest/gtest.h>

#include <random>

using namespace echinus;
using namespace echinus::test;

namespace {

bool closed(const TriangleMesh& mesh) {
    return is_closed(mesh.faces, mesh.vertices.size());
}

TriangleMesh without_last_face(TriangleMesh mesh) {
    mesh.faces.pop_back();
    return mesh;
}

} // namespace

TEST(IsClosed, HoldsForGeneratedMeshesUntilAFaceIsGoneOrTurned) {
    // The poles of the spheres have as many edges as there are meridians.
    for (const TriangleMesh& mesh : {make_box({1, 1, 1}), make_torus(1, 0.4, 12, 8), make_sphere(1, 4, 3),
                                     make_sphere(1, 13, 5), make_sphere(1, 200, 4)}) {
        EXPECT_TRUE(closed(mesh));
        EXPECT_FALSE(closed(without_last_face(mesh)));
        TriangleMesh turned = mesh;
        std::swap(turned.faces[0][0], turned.faces[0][1]);
        EXPECT_FALSE(closed(turned));
    }
}

TEST(IsClosed, CountsHowOftenAnEdgeIsUsed) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh twice = box, both_ways = without_last_face(box);
    twice.faces.insert(twice.faces.end(), box.faces.begin(), box.faces.end());
    EXPECT_TRUE(closed(twice));
    EXPECT_FALSE(closed(without_last_face(twice)));
    const auto [a, b, c] = box.faces[0];
    both_ways.faces = {{a, b, c}, {c, b, a}};
    EXPECT_TRUE(closed(both_ways));
}

TEST(IsClosed, SeesNoEdgeInAFaceWithTwoEqualCorners) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.faces.push_back({0, 1, 1});
    mesh.faces.push_back({2, 2, 2});
    EXPECT_TRUE(closed(mesh));
}

TEST(IsClosed, AgreesWithTheReportOnRandomFaces) {
    std::mt19937 random(1);
    int closed_count = 0;
    for (int n = 0; n < 2000; ++n) {
        TriangleMesh mesh;
        mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (std::size_t face = 0; face < 2 + random() % 4; ++face)
            mesh.faces.push_back({static_cast<std::uint32_t>(random() % 4),
                                  static_cast<std::uint32_t>(random() % 4),
                                  static_cast<std::uint32_t>(random() % 4)});
        EXPECT_EQ(closed(mesh), inspect(mesh).closed);
        closed_count += closed(mesh) ? 1 : 0;
    }
    EXPECT_GT(closed_count, 20);
}
