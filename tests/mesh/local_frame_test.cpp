#include "mesh/local_frame.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/intersections.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double longest_side(const TriangleMesh& mesh) {
    return 2 * inspect(mesh).bounding_sphere.radius;
}

} // namespace

TEST(LocalFrame, LeavesMeshesWhereTheyAreAsLongAsFloatsHoldThem) {
    for (const TriangleMesh& mesh : shapes_far_away())
        for (const Vec3d& offset : {Vec3d{}, Vec3d{300, -20, 5}, Vec3d{0, 500, 0}}) {
            const TriangleMesh moved = local_mesh(positions_at(mesh, offset), mesh.faces);
            EXPECT_EQ(moved.origin, Vec3d{});
            for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
                EXPECT_EQ(moved.vertices[i], Vec3f(Vec3d(mesh.vertices[i]) + offset));
        }
}

TEST(LocalFrame, KeepsTheShapeOfMeshesFarAway) {
    for (const TriangleMesh& mesh : shapes_far_away())
        for (const Vec3d& offset : places_far_away()) {
            const std::vector<Vec3d> positions = positions_at(mesh, offset);
            const TriangleMesh moved = local_mesh(positions, mesh.faces);
            EXPECT_EQ(moved.faces, mesh.faces);
            EXPECT_NE(moved.origin, Vec3d{});
            const double rounding = longest_side(mesh) * 0x1p-24;
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const Vec3d off = Vec3d(moved.vertices[i]) - (positions[i] - moved.origin);
                EXPECT_LE(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), rounding);
            }
        }
}

TEST(LocalFrame, GivesTheSameFloatsWhereverAMeshIsMovedOnTheGridOfItsOrigin) {
    const TriangleMesh box = make_box({1, 2, 3}, 4);
    const TriangleMesh here = local_mesh(positions_at(box, {1e6, 2e6, -3e6}), box.faces);
    const TriangleMesh there = local_mesh(positions_at(box, {1e9 + 1e6, -5e8 + 2e6, 7 - 3e6}), box.faces);
    EXPECT_EQ(there.vertices, here.vertices);
    EXPECT_EQ(there.origin, here.origin + Vec3d(1e9, -5e8, 7));
}

TEST(LocalFrame, HeedsOnlyPositionsThatAreUsedAndFinite) {
    const TriangleMesh box = make_box({1, 1, 1});
    std::vector<Vec3d> positions = positions_at(box, {0, 0, 0});
    positions.push_back({1e9, 1e9, 1e9}); // no face uses it
    EXPECT_EQ(local_mesh(positions, box.faces).origin, Vec3d{});

    positions = positions_at(box, {1e7, 0, 0});
    positions[3].y = kNan;
    EXPECT_EQ(local_mesh(positions, box.faces).origin, Vec3d(1e7, 0, 0));
    EXPECT_EQ(local_mesh(positions, {Triangle{0, 1, 77}}).faces[0][2], 77U); // inspect() refuses it
    EXPECT_EQ(local_mesh({}, {}).origin, Vec3d{});
}

TEST(LocalFrame, IsKeptByWhatChangesAMesh) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh far = local_mesh(positions_at(box, {1e7, 2e7, 3e7}), box.faces);
    const Vec3d origin = far.origin;
    far.faces.pop_back();
    EXPECT_EQ(weld(far).origin, origin);
    const TriangleMesh closed = repair(far, {.max_hole_edges = 8}).mesh;
    EXPECT_EQ(closed.origin, origin);
    EXPECT_NEAR(inspect(closed).signed_volume, 1, 1e-6);
}

TEST(LocalFrame, MustBeTheSameForMeshesThatAreCompared) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh far = local_mesh(positions_at(box, {1e7, 2e7, 3e7}), box.faces);
    EXPECT_FALSE(intersecting_pairs(far, far).empty());
    expect_error(ErrorCode::InvalidMesh, "different origins", [&] { intersecting_pairs(far, box); });
}

TEST(LocalFrame, OfAMeshThatCameAsFloatsIsReportedWithTheirStep) {
    const TriangleMesh box = make_box({1, 0.9, 0.8});
    const std::vector<Vec3d> exact = positions_at(box, {448262, 5411932, 112});
    std::vector<Vec3d> rounded;
    for (const Vec3d& position : exact) rounded.emplace_back(Vec3f(position));
    EXPECT_EQ(inspect(local_mesh(rounded, box.faces)).rounding_step, 0.5);
    EXPECT_EQ(inspect({std::vector<Vec3f>(rounded.begin(), rounded.end()), box.faces}).rounding_step, 0.5);
    EXPECT_EQ(inspect(local_mesh(exact, box.faces)).rounding_step, 0);
    EXPECT_NEAR(inspect(local_mesh(exact, box.faces)).signed_volume, 0.72, 1e-7);
    EXPECT_EQ(inspect(box).rounding_step, 0);
}
