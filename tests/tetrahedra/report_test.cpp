#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/soft_bodies.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

void expect_invalid(const std::string& words, const TetrahedralMesh& mesh) {
    expect_error(ErrorCode::InvalidMesh, words, [&] { require_valid_tetrahedra(mesh); });
}

} // namespace

TEST(RequireValidTetrahedra, TakesABrickAndWhateverLiesUnusedBesideIt) {
    TetrahedralMesh brick = make_brick(2);
    brick.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
    EXPECT_NO_THROW(require_valid_tetrahedra(brick));
}

TEST(RequireValidTetrahedra, NamesWhatIsWrong) {
    expect_invalid("no tetrahedra", {});
    TetrahedralMesh brick = make_brick(2);
    std::swap(brick.tetrahedra[7][0], brick.tetrahedra[7][1]);
    expect_invalid("tetrahedron 7 has a negative volume", brick);
    brick = make_brick(2);
    brick.vertices[brick.tetrahedra[0][3]].x = std::numeric_limits<float>::infinity();
    expect_invalid("of tetrahedron 0 is not finite", brick);
    brick = make_brick(2);
    brick.tetrahedra[3][0] = brick.tetrahedra[3][1];
    expect_invalid("tetrahedron 3 has vertex", brick);
    brick = make_brick(2);
    brick.tetrahedra[3][0] = 27;
    expect_invalid("tetrahedron 3 refers to vertex 27, but there are 27", brick);
    expect_invalid("tetrahedron 0 is flat",
                   {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1F, 0.1F, 0}}, {{0, 1, 2, 3}}});
    brick = make_brick(1);
    brick.tetrahedra.push_back(brick.tetrahedra[5]);
    expect_invalid("tetrahedra 5 and 6 lie on the same side", brick);
}

TEST(RequireValidTetrahedra, FindsFlatnessThatRoundingHides) {
    // Doubles of floats: the last corner lies off the plane by one unit in the last place of a large number.
    const float far = 16777216;
    TetrahedralMesh mesh{{{far, 0, 0}, {0, far, 0}, {0, 0, far}, {far, far, -far}}, {{0, 1, 2, 3}}};
    expect_invalid("tetrahedron 0 is flat", mesh);
    mesh.vertices[3].x = far - 1;
    EXPECT_ANY_THROW(require_valid_tetrahedra(mesh));
    std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]);
    EXPECT_NO_THROW(require_valid_tetrahedra(mesh));
}

TEST(TetrahedralReport, KnowsTheRegularTetrahedron) {
    const TetrahedralMesh regular{{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}}};
    const TetrahedralReport report = inspect_tetrahedra(regular);
    EXPECT_EQ(report.tetrahedron_count, 1U);
    EXPECT_EQ(report.vertex_count, 4U);
    EXPECT_NEAR(report.volume, 8.0 / 3, 1e-12);
    EXPECT_NEAR(report.least_angle_deg, 70.528779365509308, 1e-9); // acos(1/3)
    EXPECT_NEAR(report.greatest_angle_deg, 70.528779365509308, 1e-9);
    EXPECT_NEAR(report.shortest_edge, std::sqrt(8.0), 1e-12);
    EXPECT_NEAR(report.longest_edge, std::sqrt(8.0), 1e-12);
}

TEST(TetrahedralReport, KnowsABrick) {
    const TetrahedralReport report = inspect_tetrahedra(make_brick(3));
    EXPECT_EQ(report.tetrahedron_count, 6U * 27);
    EXPECT_NEAR(report.volume, 27, 1e-12);
    EXPECT_NEAR(report.least_volume, 1.0 / 6, 1e-12);
    EXPECT_NEAR(report.least_angle_deg, 45, 1e-9);
    EXPECT_NEAR(report.greatest_angle_deg, 90, 1e-9);
    EXPECT_NEAR(report.longest_edge, std::sqrt(3.0), 1e-12);
    EXPECT_TRUE(report.boundary.manifold);
}

TEST(BoundaryDistance, IsTheGapBetweenTwoBoxes) {
    TetrahedralMesh brick = make_brick(2); // from 0 to 2
    const TriangleMesh model = translated(make_box({4, 4, 4}), {1, 1, 1});
    const ExactMap map = ExactMap::build(model);
    const BoundaryDistance distance = measure_distance(brick, map);
    EXPECT_NEAR(distance.greatest_to_model, 1, 1e-5);
    EXPECT_NEAR(distance.mean_to_model, 1, 1e-5);
    EXPECT_NEAR(distance.greatest_to_boundary, std::sqrt(3.0), 1e-5); // from the corners
    EXPECT_GT(distance.mean_to_boundary, 1);
    EXPECT_LT(distance.mean_to_boundary, std::sqrt(3.0));
}

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
