#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "support/instruction_sets.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

using namespace echinus;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Vec3d> places_near_and_far() {
    test::Random random(1);
    std::vector<Vec3d> places{{0, 0, 0}};
    for (const float reach : {1e-3F, 0.5F, 1.1F, 1.5F, 3.0F, 5.0F, 1e3F, 1e12F})
        for (int n = 0; n < 10; ++n)
            places.push_back(Vec3d(test::in_cube(random, reach)) * static_cast<double>(kLatticeExtent));
    return places;
}

} // namespace

TEST(NearestFaces, OfOnePlaceDoNotDependOnTheLeafThatTheSearchBeginsWith) {
    // The last leaf has three faces only.
    TriangleMesh mesh = make_torus(1, 0.4, 25, 9);
    mesh.faces.resize(mesh.faces.size() - 7);
    const ExactMap map = ExactMap::build(mesh);
    const auto leaf_count =
        static_cast<std::uint32_t>((map.view().face_count() + TreeNode::kWidth - 1) / TreeNode::kWidth);
    ASSERT_NE(map.view().face_count() % TreeNode::kWidth, 0U);
    const Vec3d stretch{1, 1, 1};
    for (const Vec3d& place : places_near_and_far())
        for (const double farthest : {kInfinity, 0.2 * static_cast<double>(kLatticeExtent), 0.0}) {
            const std::uint32_t expected = nearest_face(map, place, stretch, farthest).value_or(kNoFace);
            test::under_each_instruction_set([&](std::string_view name) {
                for (std::uint32_t leaf = 0; leaf < leaf_count; ++leaf)
                    ASSERT_EQ(find_nearest_face(map, stretch, {place, farthest, leaf}), expected)
                        << name << ", leaf " << leaf << ", " << place.x << " " << place.y << " " << place.z;
                ASSERT_EQ(find_nearest_face(map, stretch, {place, farthest, kNoLeaf}), expected);
            });
        }
}

TEST(NearestFaces, AreFoundAroundMapsWithFewerFacesThanALeafHolds) {
    const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const ExactMap map = ExactMap::build(tetrahedron);
    for (const Vec3d& place : places_near_and_far()) {
        const std::uint32_t expected = nearest_face(map, place, {1, 1, 1}, kInfinity).value_or(kNoFace);
        test::under_each_instruction_set([&](std::string_view name) {
            EXPECT_EQ(find_nearest_face(map, {1, 1, 1}, {place, kInfinity, kNoLeaf}), expected) << name;
        });
    }
}

TEST(NearestFaces, OfPlacesNearTheSurfaceAreSoughtFromALeafNearBy) {
    const TriangleMesh mesh = make_torus(1, 0.4, 100, 40);
    const ExactMap map = ExactMap::build(mesh);
    const LatticeFrame frame = frame_of(map);
    int missed = 0;
    for (const Vec3f& p : test::surface_points(mesh, 500)) {
        const Vec3d place = frame.to_lattice(p);
        const std::uint32_t leaf = leaf_near(map, place);
        if (leaf == kNoLeaf) { // the place's ray passes the surface
            ++missed;
            continue;
        }
        double nearest = kInfinity;
        for (std::uint32_t k = 0; k < TreeNode::kWidth; ++k) {
            const auto face = static_cast<std::uint32_t>(leaf * TreeNode::kWidth + k);
            nearest = std::min(nearest, nearest_point_on_face(map, face, place, {1, 1, 1}).distance);
        }
        ASSERT_LT(nearest, 0.1 * static_cast<double>(kLatticeExtent)); // a cell is 0.03 wide
    }
    EXPECT_LT(missed, 25);
}
