#include "support/hand_made_map.hpp"

#include <echinus/distance_map.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

TEST(MapSurface, OfAConvexMeshIsClosedAndOutward) {
    for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
        const DistanceMap map = DistanceMap::build(
            make_box({2, 2, 2}), {.longitude_count = 64, .colatitude_count = 32, .pole_axis = axis});
        const MapSurface surface = reconstruct_surface(map);
        const MeshReport report = inspect(surface.mesh);
        EXPECT_TRUE(report.closed);
        EXPECT_NEAR(report.signed_volume, 8, 0.15);
        EXPECT_EQ(surface.layer.size(), surface.mesh.faces.size());
    }
}

TEST(MapSurface, OfATorusHasAnInnerAndAnOuterLayerThatBothLookOutOfTheSolid) {
    const DistanceMap map = DistanceMap::build(make_torus(1, 0.4, 60, 24));
    const MapSurface surface = reconstruct_surface(map);
    int faces_of_layer[2] = {0, 0};
    for (std::size_t i = 0; i < surface.mesh.faces.size(); ++i) {
        ASSERT_LT(surface.layer[i], 2U);
        ++faces_of_layer[surface.layer[i]];
        const auto& v = surface.mesh.vertices;
        const auto [a, b, c] = surface.mesh.faces[i];
        const Vec3f normal = cross(v[b] - v[a], v[c] - v[a]);
        const Vec3f from_centre = v[a] + v[b] + v[c];
        if (surface.layer[i] == 0)
            ASSERT_LE(dot(normal, from_centre), 0);
        else
            ASSERT_GE(dot(normal, from_centre), 0);
    }
    EXPECT_EQ(faces_of_layer[0], faces_of_layer[1]);
    EXPECT_GT(faces_of_layer[0], 5000);
}

TEST(MapSurface, LeavesCellsOfUnequalCountsOpen) {
    test::HandMadeMap map(8, 4, true);
    map.fill({0.5F});
    const std::size_t all = reconstruct_surface(map.view()).mesh.faces.size();
    map.entries(2, 1) = {0.2F, 0.4F, 0.5F};
    EXPECT_EQ(reconstruct_surface(map.view()).mesh.faces.size(), all - 4 * 2);
}
