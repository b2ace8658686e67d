#include "support/mesh_assembly.hpp"
#include "support/tetrahedra.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;
using namespace echinus::test;

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
