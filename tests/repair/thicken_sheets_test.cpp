#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace echinus;
using namespace echinus::test;

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
