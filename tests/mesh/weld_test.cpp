#include "support/expectations.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

/// Every face gets its own vertices.
TriangleMesh take_apart(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const Triangle& face : mesh.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (std::uint32_t vertex : face) soup.vertices.push_back(mesh.vertices[vertex]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}

} // namespace

TEST(Weld, PutsASoupTogetherAgain) {
    const TriangleMesh torus = make_torus(1, 0.4, 12, 8);
    const TriangleMesh welded = weld(take_apart(torus));
    EXPECT_EQ(welded.vertices.size(), torus.vertices.size());
    expect_same_faces(welded, torus);
}

TEST(Weld, LeavesAWeldedMeshAsItIs) {
    const TriangleMesh box = make_box({1, 2, 3}, 3);
    const TriangleMesh welded = weld(box);
    EXPECT_EQ(welded.vertices, box.vertices);
    EXPECT_EQ(welded.faces, box.faces);
}

TEST(Weld, TreatsZeroAndMinusZeroAsEqual) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, 0, -0.0F}, {1, 1, 0}},
                            {{0, 1, 2}, {3, 4, 1}}};
    const TriangleMesh welded = weld(mesh);
    EXPECT_EQ(welded.vertices.size(), 4U);
    EXPECT_EQ(welded.faces[1][0], welded.faces[0][0]);
}

TEST(Weld, DropsVerticesThatNoFaceUsesAndKeepsTheOrderOfTheRest) {
    const TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}}, {{4, 1, 3}}};
    const TriangleMesh welded = weld(mesh);
    EXPECT_EQ(welded.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(welded.faces, (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(Weld, RefusesAnIndexOutOfRange) {
    expect_error(ErrorCode::InvalidMesh, "face 0 of the mesh refers to vertex 1", [] {
        weld({{{0, 0, 0}}, {{0, 0, 1}}});
    });
    expect_error(ErrorCode::InvalidMesh, "face 0", [] { weld({{}, {{0, 0, 0}}}); });
}

TEST(Weld, SurvivesNaN) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh welded =
        weld({{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {0, 3, 2}}});
    EXPECT_EQ(welded.vertices.size(), 3U);
}
