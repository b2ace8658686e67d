#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

using namespace echinus;
using namespace echinus::test;

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
