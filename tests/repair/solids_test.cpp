#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

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

/// The faces and vertices that the mesh had come first and are as they were.
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

namespace {

/// On both sides of each face's middle: inside near it, outside beyond the thickness.
void expect_solid_around(const TriangleMesh& sheet, const TriangleMesh& solid, double thickness) {
    for (const auto& [a, b, c] : sheet.faces) {
        const Vec3d p(sheet.vertices[a]), q(sheet.vertices[b]), r(sheet.vertices[c]);
        const Vec3d normal = cross(q - p, r - p) * (1 / length(cross(q - p, r - p)));
        for (const double side : {-1, 1}) {
            const Vec3d middle = (p + q + r) * (1.0 / 3);
            EXPECT_NEAR(winding_number(solid, middle + normal * (side * 0.48 * thickness)), 1, 1e-6);
            EXPECT_NEAR(winding_number(solid, middle + normal * (side * 1.05 * thickness)), 0, 1e-6);
        }
    }
}

/// A band of squares, turned half round before its ends are joined.
TriangleMesh moebius_strip(std::uint32_t count) {
    TriangleMesh strip;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        for (const double side : {-0.3, 0.3}) {
            const double radius = 1 + side * std::cos(angle / 2);
            strip.vertices.push_back(
                Vec3f(Vec3d{radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)}));
        }
        const std::uint32_t a = 2 * i, b = a + 1;
        const bool last = i + 1 == count;
        const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        strip.faces.push_back({a, b, c});
        strip.faces.push_back({b, d, c});
    }
    return strip;
}

RepairedMesh thickened(const TriangleMesh& mesh, double thickness) {
    return repair(mesh, {.sheet_thickness = thickness});
}

} // namespace

TEST(ThickenSheets, MakesAPlateOfAFlatSheet) {
    TriangleMesh sheet = stacked_sheets(1, 5);
    for (Vec3f& vertex : sheet.vertices) vertex.z = 0;
    const RepairedMesh plate = thickened(sheet, 0.125);
    const MeshReport report = inspect(plate.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_NEAR(report.signed_volume, 4 * 0.125, 1e-6);
    EXPECT_EQ(plate.report.sheets_thickened, 1U);
    EXPECT_EQ(plate.mesh.faces.size(), sheet.faces.size() + plate.report.faces_added);
    expect_solid_around(sheet, plate.mesh, 0.125);
}

TEST(ThickenSheets, MakesAShellOfABowl) {
    TriangleMesh bowl = make_sphere(1, 40, 20);
    bowl.faces.resize(bowl.faces.size() - 100);
    const RepairedMesh shell = thickened(bowl, 0.05);
    EXPECT_TRUE(inspect(shell.mesh).closed);
    EXPECT_EQ(shell.report.sheets_thickened, 1U);
    expect_solid_around(bowl, shell.mesh, 0.05);
}

TEST(ThickenSheets, MakesASolidOfEachPieceOfASoup) {
    const TriangleMesh soup = exploded(make_torus(1, 0.4, 24, 12), 0.97F);
    const RepairedMesh solids = thickened(soup, 0.01);
    EXPECT_TRUE(inspect(solids.mesh).closed);
    EXPECT_EQ(solids.report.sheets_thickened, soup.faces.size());
    EXPECT_EQ(inspect(solids.mesh).component_count, soup.faces.size());
    expect_solid_around(soup, solids.mesh, 0.01);
}

TEST(ThickenSheets, LeavesClosedPartsAsTheyAre) {
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    const RepairedMesh solids = thickened(joined({box, translated(stacked_sheets(1, 3), {0, 0, 3})}), 0.1);
    ASSERT_GE(solids.mesh.faces.size(), box.faces.size());
    for (std::size_t i = 0; i < box.vertices.size(); ++i) EXPECT_EQ(solids.mesh.vertices[i], box.vertices[i]);
    for (std::size_t i = 0; i < box.faces.size(); ++i) EXPECT_EQ(solids.mesh.faces[i], box.faces[i]);
    EXPECT_EQ(inspect(solids.mesh).component_count, 2U);
    EXPECT_FALSE(thickened(box, 0.1).report.changed_anything());
}

TEST(ThickenSheets, TakesEdgesWithoutTwoAgreeingFacesForRims) {
    const TriangleMesh strip = moebius_strip(24);
    EXPECT_TRUE(inspect(thickened(strip, 0.05).mesh).closed);
    EXPECT_EQ(thickened(strip, 0.05).report.sheets_thickened, 1U);

    const TriangleMesh three_at_an_edge{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                                        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
    const RepairedMesh solids = thickened(three_at_an_edge, 0.05);
    EXPECT_TRUE(inspect(solids.mesh).closed);
    EXPECT_EQ(solids.report.sheets_thickened, 3U);
    expect_solid_around({three_at_an_edge.vertices, {{0, 1, 4}}}, solids.mesh, 0.05);
}

TEST(ThickenSheets, ClosesAnyTangle) {
    Random random(2);
    for (int n = 0; n < 300; ++n) {
        TriangleMesh tangle;
        for (int i = 0; i < 7; ++i) tangle.vertices.push_back(in_cube(random, 1));
        const auto vertex = [&] { return static_cast<std::uint32_t>(random() % 7); };
        for (int i = 0; i < 30; ++i) tangle.faces.push_back({vertex(), vertex(), vertex()});
        EXPECT_TRUE(inspect(thickened(tangle, 0.05).mesh).closed);
    }
}

TEST(ThickenSheets, TakesFacesWithoutAreaToo) {
    const TriangleMesh lines{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}};
    const RepairedMesh solid = thickened(lines, 0.1);
    EXPECT_TRUE(inspect(solid.mesh).closed);
}

TEST(ThickenSheets, RefusesAThicknessThatDoesNotSuitTheMesh) {
    const TriangleMesh sheet = stacked_sheets(1, 3);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double wrong : {nan, -1.0, std::numeric_limits<double>::infinity()})
        expect_error(ErrorCode::InvalidOptions, "must be a finite length", [&] { thickened(sheet, wrong); });
    for (const double wrong : {1e-6, 10.0, 1e300, 1e-300})
        expect_error(ErrorCode::InvalidOptions, "for this mesh it must be", [&] { thickened(sheet, wrong); });
    expect_error(ErrorCode::InvalidOptions, "resolve", [&] {
        thickened(translated(sheet, {1e6F, 0, 0}), 0.1);
    });
}

TEST(ThickenSheets, RefusesWhatIsNoMeshOrLeavesTheRangeOfFloat) {
    expect_error(ErrorCode::InvalidMesh, "no faces", [] { thickened({}, 0.1); });
    TriangleMesh sheet = stacked_sheets(1, 3);
    for (Vec3f& vertex : sheet.vertices) vertex = vertex * 3e38F;
    sheet.vertices[0].z = 3.4e38F;
    expect_error(ErrorCode::InvalidMesh, "not finite", [&] { thickened(sheet, 2e38); });
}

namespace {

constexpr RepairOptions kDropInner{.drop_inner_faces = true};

using Faces = std::vector<std::uint32_t>;

Faces numbers(std::size_t first, std::size_t end) {
    Faces result(end - first);
    std::iota(result.begin(), result.end(), static_cast<std::uint32_t>(first));
    return result;
}

bool is_inside(const TriangleMesh& mesh, const Vec3d& p) {
    return std::fabs(winding_number(mesh, p)) > 0.5;
}

void expect_unchanged(const TriangleMesh& mesh) {
    const RepairedMesh repaired = repair(mesh, kDropInner);
    EXPECT_FALSE(repaired.report.changed_anything());
    EXPECT_EQ(repaired.mesh.faces, mesh.faces);
}

/// Drops the faces from a number on, and nothing else.
void expect_dropped_from(std::size_t first, const TriangleMesh& mesh) {
    const RepairedMesh repaired = repair(mesh, kDropInner);
    EXPECT_EQ(repaired.report.inner_faces_dropped, numbers(first, mesh.faces.size()));
    EXPECT_EQ(repaired.mesh.vertices, mesh.vertices);
    EXPECT_EQ(repaired.mesh.faces, std::vector(mesh.faces.begin(), mesh.faces.begin() + first));
}

/// A sheet of two triangles across the z axis.
TriangleMesh square(float size) {
    return {{{-size, -size, 0}, {size, -size, 0}, {size, size, 0}, {-size, size, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

} // namespace

TEST(InnerFaces, AreThoseOfAPartInAnother) {
    const TriangleMesh body = make_box({2, 2, 2}, 3);
    expect_dropped_from(body.faces.size(), joined({body, make_torus(0.5, 0.2, 12, 8)}));
}

TEST(InnerFaces, AreNotThoseOfACavity) {
    expect_unchanged(joined({make_box({2, 2, 2}, 3), turned_inside_out(make_torus(0.5, 0.2, 12, 8))}));
}

TEST(InnerFaces, AreAlsoThoseOfACavityWithinAPartWithinAnother) {
    const TriangleMesh body = make_box({2, 2, 2}, 3);
    expect_dropped_from(body.faces.size(), joined({body, make_box({1, 1, 1}, 2),
                                                   turned_inside_out(make_box({0.5, 0.5, 0.5}, 1))}));
}

TEST(InnerFaces, StayWhereTheirPartCrossesTheSurface) {
    expect_unchanged(joined({make_box({2, 2, 2}, 4), translated(make_box({1, 1, 1}, 4), {1, 0, 0})}));
}

TEST(InnerFaces, OfASheetInASolidGoSoThatTheMeshIsClosed) {
    const TriangleMesh body = make_box({2, 2, 2}, 3);
    const TriangleMesh whole = joined({body, square(0.7F)});
    EXPECT_FALSE(inspect(whole).closed);
    expect_dropped_from(body.faces.size(), whole);
    EXPECT_TRUE(inspect(repair(whole, kDropInner).mesh).closed);
}

TEST(InnerFaces, OfAWallThatIsJoinedToTheHullGo) {
    TriangleMesh mesh = make_box({1, 1, 1}, 2);
    const std::size_t hull_count = mesh.faces.size();
    const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(0.0F, 0.0F, 0.0F);
    const auto vertex_at = [&](float y, float z) {
        for (std::uint32_t v = 0; v < middle; ++v)
            if (mesh.vertices[v] == Vec3f{0, y, z}) return v;
        ADD_FAILURE() << "the box has no vertex there";
        return 0U;
    };
    constexpr float h = 0.5F;
    const std::vector<std::uint32_t> rim{vertex_at(h, 0),  vertex_at(h, h),  vertex_at(0, h),
                                         vertex_at(-h, h), vertex_at(-h, 0), vertex_at(-h, -h),
                                         vertex_at(0, -h), vertex_at(h, -h)};
    for (std::size_t i = 0; i < rim.size(); ++i)
        mesh.faces.push_back({rim[i], rim[(i + 1) % rim.size()], middle});
    EXPECT_FALSE(inspect(mesh).closed);
    expect_dropped_from(hull_count, mesh);
}

TEST(InnerFaces, AreTheSameOfAMeshThatIsInsideOut) {
    const TriangleMesh body = make_box({2, 2, 2}, 3);
    expect_dropped_from(body.faces.size(), turned_inside_out(joined({body, make_torus(0.5, 0.2, 12, 8)})));
}

TEST(InnerFaces, LeaveTheSolidAsItWas) {
    const TriangleMesh ball = make_sphere(1, 16, 8);
    const std::vector<NamedSoup> parts{
        {"an exploded torus", exploded(make_torus(1, 0.4, 16, 8), 0.97F)},
        {"a bowl", {ball.vertices, {ball.faces.begin() + 60, ball.faces.end()}}},
        {"boxes and rings", assembly(8)}};
    for (const auto& [name, soup] : parts) {
        const TriangleMesh body = make_box({5, 3, 3}, 2);
        // Nearly all within the body, and a part of it through the body's surface.
        const TriangleMesh mesh = joined({body, soup, translated(make_torus(0.4, 0.1, 12, 8), {2.4F, 0, 0})});
        const RepairedMesh repaired = repair(mesh, kDropInner);
        EXPECT_GE(repaired.report.inner_faces_dropped.size(), soup.faces.size() / 2) << name;
        Random random(3);
        for (int i = 0; i < 100; ++i) {
            const Vec3d p(in_cube(random, 3));
            if (unsigned_distance(mesh, p) > 1e-3)
                EXPECT_EQ(is_inside(repaired.mesh, p), is_inside(mesh, p)) << name;
        }
    }
}

TEST(InnerFaces, OfASoupLeaveWhatIsBesideTheOthersAsItWas) {
    const TriangleMesh soup = assembly(20);
    const RepairedMesh repaired = repair(soup, kDropInner);
    EXPECT_FALSE(repaired.mesh.faces.empty());
    for (const auto& [a, b, c] : repaired.mesh.faces) {
        const Vec3d p(soup.vertices[a]), q(soup.vertices[b]), r(soup.vertices[c]);
        const Vec3d normal = cross(q - p, r - p);
        for (const double offset : {-4e-5, 4e-5}) {
            const Vec3d place = (p + q + r) * (1.0 / 3) + normal * (offset / length(normal));
            const double before = winding_number(soup, place);
            if (std::fabs(std::fabs(before) - 0.5) > 1e-3)
                EXPECT_EQ(is_inside(repaired.mesh, place), std::fabs(before) > 0.5);
        }
    }
}

TEST(InnerFaces, RefuseWhatIsNoMeshOrHasNoMap) {
    expect_error(ErrorCode::InvalidMesh, "no faces", [] { repair({}, kDropInner); });
    TriangleMesh box = make_box({1, 1, 1});
    box.vertices[3].y = std::numeric_limits<float>::quiet_NaN();
    expect_error(ErrorCode::InvalidMesh, "vertex 3", [&] { repair(box, kDropInner); });
    box.vertices[3].y = 1e30F;
    expect_error(ErrorCode::InvalidMesh, "radius", [&] { repair(box, kDropInner); });
}
