#include "support/expect_error.hpp"
#include "support/tetrahedra.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

TEST(Boundary, OfATetrahedronIsItsFourFacesOutward) {
    const TetrahedralMesh one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
    const MeshReport report = inspect(boundary(one));
    EXPECT_EQ(report.face_count, 4U);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_NEAR(report.signed_volume, 1.0 / 6, 1e-12);
}

TEST(Boundary, OfABrickEnclosesItsVolumeAndKeepsTheNumbers) {
    const TetrahedralMesh brick = make_brick(4);
    const TriangleMesh surface = boundary(brick);
    EXPECT_EQ(surface.vertices, brick.vertices);
    const MeshReport report = inspect(surface);
    EXPECT_EQ(report.face_count, 6U * 4 * 4 * 2);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_NEAR(report.signed_volume, 64, 1e-9);
}

TEST(Boundary, OfBodiesThatMeetInAnEdgeIsClosedButNotManifold) {
    const TetrahedralMesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                              {{0, 1, 2, 3}, {0, 1, 4, 5}}};
    const MeshReport report = inspect(boundary(two));
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.manifold);
}

TEST(Boundary, RefusesTetrahedraOnTheSameSideOfAFace) {
    const TetrahedralMesh folded{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}},
                                 {{0, 1, 2, 3}, {0, 1, 2, 4}}};
    expect_error(ErrorCode::InvalidMesh, "tetrahedra 0 and 1 lie on the same side",
                 [&] { boundary(folded); });
}

TEST(Boundary, RefusesNumbersBeyondTheVertices) {
    expect_error(ErrorCode::InvalidMesh, "tetrahedron 0 refers to vertex 4, but there are 4 vertices", [] {
        boundary({std::vector<Vec3f>(4), {{0, 1, 2, 4}}});
    });
}
