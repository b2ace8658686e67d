#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

constexpr RepairOptions kCloseHoles{.max_hole_edges = 32};

template <typename Goes>
TriangleMesh without_faces(TriangleMesh mesh, const Goes& goes) {
    std::erase_if(mesh.faces, [&](const Triangle& face) {
        return goes(
            (Vec3d(mesh.vertices[face[0]]) + Vec3d(mesh.vertices[face[1]]) + Vec3d(mesh.vertices[face[2]])) *
            (1.0 / 3));
    });
    return mesh;
}

/// What the mesh had comes first and is as it was.
void expect_only_faces_added(const TriangleMesh& before, const RepairedMesh& after) {
    EXPECT_EQ(after.mesh.vertices, before.vertices);
    ASSERT_EQ(after.mesh.faces.size(), before.faces.size() + after.report.faces_added);
    EXPECT_TRUE(std::equal(before.faces.begin(), before.faces.end(), after.mesh.faces.begin()));
}

double area_of(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces)
        sum += length(cross(Vec3d(mesh.vertices[b]) - Vec3d(mesh.vertices[a]),
                            Vec3d(mesh.vertices[c]) - Vec3d(mesh.vertices[a]))) /
               2;
    return sum;
}

bool is_on_top(const Vec3d& p) {
    return p.z > 0.49;
}

} // namespace

TEST(CloseHoles, GivesBackTheSolidThatLostSomeFaces) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    Random random(1);
    TriangleMesh holed = torus;
    for (int i = 0; i < 12; ++i) { // of one face, or of several neighbours
        const Vec3d place(torus.vertices[random() % torus.vertices.size()]);
        holed = without_faces(holed, [&](const Vec3d& p) { return length(p - place) < 0.05 + 0.005 * i; });
    }
    ASSERT_FALSE(inspect(holed).closed);
    const RepairedMesh repaired = repair(holed, kCloseHoles);
    EXPECT_TRUE(inspect(repaired.mesh).closed);
    EXPECT_GE(repaired.report.holes_closed, 8U);
    EXPECT_EQ(repaired.report.holes_left, 0U);
    expect_only_faces_added(holed, repaired);
    for (int i = 0; i < 300; ++i) {
        const Vec3d p(in_cube(random, 1.5F));
        if (unsigned_distance(torus, p) > 0.05)
            EXPECT_NEAR(winding_number(repaired.mesh, p), winding_number(torus, p), 1e-9);
    }
}

TEST(CloseHoles, FillsAFlatHoleOfAnyShapeFlat) {
    const TriangleMesh box = make_box({1, 1, 1}, 6);
    const auto is_in_an_l = [](const Vec3d& p) {
        return is_on_top(p) && p.x > -0.3 && p.y > -0.3 && p.x < 0.3 && p.y < 0.3 && (p.x < 0 || p.y < 0);
    };
    const RepairedMesh repaired = repair(without_faces(box, is_in_an_l), kCloseHoles);
    EXPECT_EQ(repaired.report.holes_closed, 1U);
    EXPECT_TRUE(inspect(repaired.mesh).closed);
    EXPECT_TRUE(inspect(repaired.mesh).manifold);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 1, 1e-6);
    EXPECT_NEAR(area_of(repaired.mesh), 6, 1e-6);
    EXPECT_EQ(inspect(repaired.mesh).degenerate_faces.count, 0U);
}

TEST(CloseHoles, PartsHolesThatTouchAtAVertex) {
    const TriangleMesh box = make_box({1, 1, 1}, 4);
    const auto in_opposite_quarters = [](const Vec3d& p) {
        return is_on_top(p) && std::max(std::fabs(p.x), std::fabs(p.y)) < 0.25 && p.x * p.y > 0;
    };
    const RepairedMesh repaired = repair(without_faces(box, in_opposite_quarters), kCloseHoles);
    EXPECT_EQ(repaired.report.holes_closed, 2U);
    EXPECT_TRUE(inspect(repaired.mesh).closed);
    EXPECT_NEAR(area_of(repaired.mesh), 6, 1e-6);
}

TEST(CloseHoles, LeavesHolesOfMoreEdges) {
    const TriangleMesh box =
        without_faces(make_box({1, 1, 1}, 4), [](const Vec3d& p) { return is_on_top(p) && p.x < 0; });
    const RepairedMesh left = repair(box, {.max_hole_edges = 11});
    EXPECT_EQ(left.report.holes_left, 1U);
    EXPECT_FALSE(left.report.changed_anything());
    EXPECT_EQ(left.mesh.faces, box.faces);
    const RepairedMesh closed = repair(box, {.max_hole_edges = 12});
    EXPECT_EQ(closed.report.holes_closed, 1U);
    EXPECT_TRUE(inspect(closed.mesh).closed);
}

TEST(CloseHoles, LeavesTheRimsOfSheets) {
    const TriangleMesh soup = exploded(make_torus(1, 0.4, 12, 6), 0.9F);
    const RepairedMesh repaired = repair(soup, kCloseHoles);
    EXPECT_EQ(repaired.report.holes_closed, 0U);
    EXPECT_EQ(repaired.report.holes_left, soup.faces.size());
    EXPECT_EQ(repaired.mesh.faces, soup.faces);
}

TEST(CloseHoles, TurnsAPartThatIsClosedByThenTheRightWayRound) {
    TriangleMesh box = turned_inside_out(make_box({1, 1, 1}, 2));
    box.faces.pop_back();
    const RepairedMesh repaired = repair(box, {.flip_inside_out = true, .max_hole_edges = 3});
    EXPECT_EQ(repaired.report.components_flipped, 1U);
    EXPECT_NEAR(inspect(repaired.mesh).signed_volume, 1, 1e-6);
}

TEST(CloseHoles, BalancesEveryEdgeOfAnyTangleWhereNoHoleIsLeft) {
    Random random(2);
    int all_closed = 0;
    for (int n = 0; n < 300; ++n) {
        TriangleMesh tangle;
        for (int i = 0; i < 7; ++i) tangle.vertices.push_back(in_cube(random, 1));
        const auto vertex = [&] { return static_cast<std::uint32_t>(random() % 7); };
        for (int i = 0; i < 30; ++i) tangle.faces.push_back({vertex(), vertex(), vertex()});
        const RepairedMesh repaired = repair(tangle, kCloseHoles);
        expect_only_faces_added(tangle, repaired);
        EXPECT_EQ(inspect(repaired.mesh).closed, repaired.report.holes_left == 0);
        all_closed += repaired.report.holes_left == 0 ? 1 : 0;
    }
    EXPECT_GT(all_closed, 100);
}

TEST(CloseHoles, RefusesALimitBeyondTheLargest) {
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_NO_THROW(repair(box, {.max_hole_edges = RepairOptions::kMaxHoleEdges}));
    expect_error(ErrorCode::InvalidOptions, "257 edges cannot be closed; at most 256",
                 [&] { repair(box, {.max_hole_edges = 257}); });
}

TEST(CloseHoles, RefusesWhatIsNoMesh) {
    expect_error(ErrorCode::InvalidMesh, "no faces", [] { repair({}, kCloseHoles); });
    TriangleMesh box = make_box({1, 1, 1});
    box.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
    expect_error(ErrorCode::InvalidMesh, "vertex 3", [&] { repair(box, kCloseHoles); });
}

TEST(CloseHoles, WorksAtTheEndsOfTheRangeOfFloat) {
    for (const float size : {1e-30F, 3e38F}) {
        TriangleMesh box = make_box({1, 1, 1}, 3);
        for (Vec3f& vertex : box.vertices) vertex *= size;
        box = without_faces(box, [&](const Vec3d& p) {
            return p.z > 0.49 * size && std::max(std::fabs(p.x), std::fabs(p.y)) < 0.2 * size;
        });
        const RepairedMesh repaired = repair(box, kCloseHoles);
        EXPECT_EQ(repaired.report.holes_closed, 1U);
        EXPECT_TRUE(inspect(repaired.mesh).closed);
    }
}
