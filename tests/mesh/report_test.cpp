#include "mesh/seams.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>

using namespace echinus;
using namespace echinus::test;

namespace {

void expect_invalid(const TriangleMesh& mesh, const std::string& words) {
    expect_error(ErrorCode::InvalidMesh, words, [&] { require_valid(mesh); });
}

const std::vector<Vec3f> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

} // namespace

TEST(RequireValid, AcceptsASingleFace) {
    EXPECT_NO_THROW(require_valid({kCorners, {{0, 1, 2}}}));
}

TEST(RequireValid, RefusesAMeshWithoutFaces) {
    expect_invalid({}, "no faces");
    expect_invalid({kCorners, {}}, "no faces");
}

TEST(RequireValid, NamesTheFirstFaceWithAnIndexOutOfRange) {
    expect_invalid({kCorners, {{0, 1, 2}, {0, 1, 4}, {9, 9, 9}}}, "face 1 of the mesh refers to vertex 4");
}

TEST(RequireValid, NamesTheFirstFaceWithAPositionThatIsNotFinite) {
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        auto vertices = kCorners;
        vertices[3].y = bad;
        expect_invalid({vertices, {{0, 1, 2}, {0, 1, 3}}}, "face 1 of the mesh uses vertex 3");
        EXPECT_NO_THROW(require_valid({vertices, {{0, 1, 2}}})); // an unused vertex may be anything
    }
}

namespace {

bool closed(const TriangleMesh& mesh) {
    return is_closed(mesh.faces, mesh.vertices.size());
}

TriangleMesh without_last_face(TriangleMesh mesh) {
    mesh.faces.pop_back();
    return mesh;
}

} // namespace

TEST(IsClosed, HoldsForGeneratedMeshesUntilAFaceIsGoneOrTurned) {
    // The poles of the spheres have as many edges as there are meridians.
    for (const TriangleMesh& mesh : {make_box({1, 1, 1}), make_torus(1, 0.4, 12, 8), make_sphere(1, 4, 3),
                                     make_sphere(1, 13, 5), make_sphere(1, 200, 4)}) {
        EXPECT_TRUE(closed(mesh));
        EXPECT_FALSE(closed(without_last_face(mesh)));
        TriangleMesh turned = mesh;
        std::swap(turned.faces[0][0], turned.faces[0][1]);
        EXPECT_FALSE(closed(turned));
    }
}

TEST(IsClosed, CountsHowOftenAnEdgeIsUsed) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh twice = box, both_ways = without_last_face(box);
    twice.faces.insert(twice.faces.end(), box.faces.begin(), box.faces.end());
    EXPECT_TRUE(closed(twice));
    EXPECT_FALSE(closed(without_last_face(twice)));
    const auto [a, b, c] = box.faces[0];
    both_ways.faces = {{a, b, c}, {c, b, a}};
    EXPECT_TRUE(closed(both_ways));
}

TEST(IsClosed, SeesNoEdgeInAFaceWithTwoEqualCorners) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.faces.push_back({0, 1, 1});
    mesh.faces.push_back({2, 2, 2});
    EXPECT_TRUE(closed(mesh));
}

TEST(IsClosed, AgreesWithTheReportOnRandomFaces) {
    std::mt19937 random(1);
    int closed_count = 0;
    for (int n = 0; n < 2000; ++n) {
        TriangleMesh mesh;
        mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (std::size_t face = 0; face < 2 + random() % 4; ++face)
            mesh.faces.push_back({static_cast<std::uint32_t>(random() % 4),
                                  static_cast<std::uint32_t>(random() % 4),
                                  static_cast<std::uint32_t>(random() % 4)});
        EXPECT_EQ(closed(mesh), inspect(mesh).closed);
        closed_count += closed(mesh) ? 1 : 0;
    }
    EXPECT_GT(closed_count, 20);
}

namespace {

using Faces = std::vector<std::uint32_t>;

TriangleMesh without_face(TriangleMesh mesh, std::size_t face) {
    mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(face));
    return mesh;
}

TriangleMesh with_face(TriangleMesh mesh, const Triangle& face) {
    mesh.faces.push_back(face);
    return mesh;
}

void expect_sound(const TriangleMesh& mesh) {
    const MeshReport report = inspect(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    for (const Fault& fault : {report.border_edges, report.nonmanifold_edges, report.misoriented_edges,
                               report.duplicate_faces, report.degenerate_faces}) {
        EXPECT_EQ(fault.count, 0U);
        EXPECT_TRUE(fault.first_faces.empty());
    }
    EXPECT_EQ(report.component_count, 1U);
    EXPECT_GT(report.signed_volume, 0);
}

/// Area of a regular polygon with this circumradius.
double polygon_area(double radius, double corner_count) {
    return corner_count / 2 * radius * radius * std::sin(2 * std::numbers::pi / corner_count);
}

} // namespace

TEST(MeshReport, FindsNothingWrongWithWhatTheGeneratorsMake) {
    for (std::uint32_t segments : {3U, 4U, 7U, 24U}) {
        expect_sound(make_torus(1, 0.4, segments, segments + 1));
        expect_sound(make_sphere(2, segments, segments));
        expect_sound(make_box({1, 2, 3}, segments));
    }
    expect_sound(make_sphere(1, 3, 2)); // two tetrahedra
    expect_sound(make_box({1, 1, 1}, 1));
}

TEST(MeshReport, GivesTheVolumeOfABox) {
    EXPECT_NEAR(inspect(make_box({1, 2, 3}, 3)).signed_volume, 6, 1e-14);
    EXPECT_NEAR(inspect(turned_inside_out(make_box({1, 2, 3}, 3))).signed_volume, -6, 1e-14);
}

TEST(MeshReport, GivesTheVolumeOfATorusOfPolygons) {
    // Pappus: the area of the profile, a regular m-gon, times the path of its centre. The path is also a
    // polygon here: a wedge of angle a between two profiles has the volume area * sin(a) * major radius,
    // since all four corners of a quadrilateral between them lie in one plane.
    for (double n : {3.0, 5.0, 60.0})
        for (double m : {3.0, 4.0, 24.0}) {
            const double area = polygon_area(0.4, m);
            const double path = n * std::sin(2 * std::numbers::pi / n) * 1.0;
            const TriangleMesh torus = make_torus(1, 0.4, std::uint32_t(n), std::uint32_t(m));
            const double volume = inspect(torus).signed_volume;
            EXPECT_NEAR(volume, area * path, 1e-6) << n << " x " << m;
        }
}

TEST(MeshReport, SeesTheVolumeOfASphereConvergeFromBelow) {
    const double exact = 4.0 / 3 * std::numbers::pi;
    double previous_error = exact;
    for (std::uint32_t rows : {8U, 16U, 32U, 64U}) {
        const double error = exact - inspect(make_sphere(1, 2 * rows, rows)).signed_volume;
        EXPECT_GT(error, 0);
        EXPECT_LT(error, 0.3 * previous_error); // second order: a quarter each time
        previous_error = error;
    }
}

TEST(MeshReport, DoesNotLoseTheVolumeFarFromTheOrigin) {
    const TriangleMesh box = translated(make_box({2, 2, 2}, 2), {1e6F, -1e6F, 2e6F});
    EXPECT_NEAR(inspect(box).signed_volume, 8, 1e-9);
}

TEST(MeshReport, CountsTheEdgesOfAHoleAsBorder) {
    const TriangleMesh sphere = make_sphere(1, 12, 8);
    const MeshReport report = inspect(without_face(sphere, 30));
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.border_edges.count, 3U);
    EXPECT_EQ(report.border_edges.first_faces.size(), 3U);
    // The faces named are exactly those that share an edge with the missing one.
    for (std::uint32_t face : report.border_edges.first_faces) {
        const Triangle& neighbour = sphere.faces[face < 30 ? face : face + 1];
        const auto shared = std::count_if(neighbour.begin(), neighbour.end(), [&](std::uint32_t v) {
            return std::count(sphere.faces[30].begin(), sphere.faces[30].end(), v) != 0;
        });
        EXPECT_EQ(shared, 2);
    }
}

TEST(MeshReport, CountsASingleFaceAsThreeBorderEdges) {
    const MeshReport report = inspect({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.border_edges.count, 3U);
    EXPECT_EQ(report.border_edges.first_faces, (Faces{0}));
}

TEST(MeshReport, CallsAMeshClosedWhoseCornersDifferByLessThanMapsResolve) {
    const TriangleMesh box = make_box({1, 1, 1}, 3);
    const double radius = inspect(box).bounding_sphere.radius;
    for (const auto& [share, closed] : {std::pair(0.0, true), {0x1p-22, true}, {0x1p-20, false}}) {
        TriangleMesh mesh = box; // each face with corners of its own
        mesh.vertices.clear();
        for (std::size_t face = 0; face < mesh.faces.size(); ++face)
            for (std::uint32_t& corner : mesh.faces[face]) {
                const float apart = face % 2 == 0 ? 0 : static_cast<float>(share * radius);
                mesh.vertices.push_back(box.vertices[corner] + Vec3f{0, apart, 0});
                corner = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
            }
        const MeshReport report = inspect(mesh);
        EXPECT_EQ(report.closed, closed) << share;
        EXPECT_EQ(report.border_edges.count == 0, closed) << share;
        EXPECT_EQ(report.component_count == 1, closed) << share;
    }
}

TEST(MeshReport, DoesNotTakeAChainOfNearCornersForOne) {
    // A strip so fine that each of its corners is near to the next, but not to those after that.
    const float step = 0x1.8p-22F;
    TriangleMesh mesh{{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    for (int i = 0; i < 50; ++i) {
        mesh.vertices.push_back({static_cast<float>(i) * step, 0, 0.5F});
        mesh.vertices.push_back({static_cast<float>(i) * step, 0x1p-10F, 0.5F});
        const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
        if (i > 0)
            mesh.faces.insert(mesh.faces.end(), {{last - 3, last - 1, last - 2}, {last - 2, last - 1, last}});
    }
    EXPECT_GE(inspect(mesh).border_edges.count, 3U + 20U);
}

TEST(MeshReport, SaysOfAMoebiusStripThatItIsNotOrientable) {
    // A band of triangles; its ends are joined straight or with half a turn.
    for (const bool with_half_a_turn : {false, true}) {
        TriangleMesh band;
        constexpr std::uint32_t kCount = 24;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const double around = 2 * std::numbers::pi * i / kCount;
            const double tilt = with_half_a_turn ? around / 2 : 0;
            for (const double side : {-0.3, 0.3})
                band.vertices.push_back(
                    Vec3f(Vec3d{(1 + side * std::cos(tilt)) * std::cos(around),
                                (1 + side * std::cos(tilt)) * std::sin(around), side * std::sin(tilt)}));
            std::uint32_t c = 2 * (i + 1) % (2 * kCount), d = c + 1;
            if (i + 1 == kCount && with_half_a_turn) std::swap(c, d);
            band.faces.push_back({2 * i, 2 * i + 1, c});
            band.faces.push_back({2 * i + 1, d, c});
        }
        EXPECT_EQ(inspect(band).orientable, !with_half_a_turn);
        std::swap(band.faces[7][0], band.faces[7][1]); // turned faces do not matter
        EXPECT_EQ(inspect(band).orientable, !with_half_a_turn);
        EXPECT_EQ(inspect(band).misoriented_edges.count, with_half_a_turn ? 3U : 2U);
    }
}

TEST(MeshReport, CountsAFinAsANonmanifoldEdge) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.vertices.push_back({3, 3, 3});
    const Triangle first = mesh.faces[0];
    const MeshReport report = inspect(with_face(mesh, {first[0], first[1], 8}));
    EXPECT_FALSE(report.closed);
    EXPECT_FALSE(report.manifold);
    EXPECT_EQ(report.nonmanifold_edges.count, 1U);
    EXPECT_EQ(report.nonmanifold_edges.first_faces.size(), 3U);
    EXPECT_EQ(report.nonmanifold_edges.first_faces.back(), 12U);
    EXPECT_EQ(report.border_edges.count, 2U);
    EXPECT_EQ(report.border_edges.first_faces, (Faces{12}));
}

TEST(MeshReport, CountsTheEdgesOfATurnedFaceAsMisoriented) {
    TriangleMesh mesh = make_box({1, 1, 1}, 2);
    std::swap(mesh.faces[5][0], mesh.faces[5][1]);
    const MeshReport report = inspect(mesh);
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.misoriented_edges.count, 3U);
    EXPECT_EQ(report.misoriented_edges.first_faces.size(), 4U);
    EXPECT_EQ(std::count(report.misoriented_edges.first_faces.begin(),
                         report.misoriented_edges.first_faces.end(), 5U),
              1);
    EXPECT_EQ(report.border_edges.count, 0U);
    EXPECT_EQ(report.nonmanifold_edges.count, 0U);
}

TEST(MeshReport, CallsTwoBoxesThatShareAnEdgeClosedButNotManifold) {
    // Looking along the shared edge, each box a square:
    //
    //          +---+
    //          |   |
    //      +---+---+
    //      |   |
    //      +---+
    const TriangleMesh box = make_box({1, 1, 1});
    const MeshReport report = inspect(weld(joined({box, translated(box, {1, 1, 0})})));
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.manifold);
    EXPECT_EQ(report.nonmanifold_edges.count, 1U);
    EXPECT_EQ(report.misoriented_edges.count, 0U);
    EXPECT_EQ(report.component_count, 1U);
}

TEST(MeshReport, CallsTwoBoxesThatShareAVertexClosedButNotManifold) {
    const TriangleMesh box = make_box({1, 1, 1});
    const MeshReport report = inspect(weld(joined({box, translated(box, {1, 1, 1})})));
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.manifold);
    EXPECT_EQ(report.nonmanifold_edges.count, 0U);
    EXPECT_EQ(report.component_count, 1U);
}

TEST(MeshReport, CallsAnOpenFanManifoldAndTwoFansAtOneVertexNot) {
    const std::vector<Vec3f> vertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
    EXPECT_TRUE(inspect({vertices, {{0, 1, 2}, {0, 2, 3}}}).manifold);
    EXPECT_FALSE(inspect({vertices, {{0, 1, 2}, {0, 4, 5}}}).manifold);
}

TEST(MeshReport, CountsComponents) {
    TriangleMesh mesh = make_box({1, 1, 1});
    for (int i = 1; i < 5; ++i)
        mesh = joined({mesh, translated(make_sphere(0.4, 6, 4), {3.0F * float(i), 0, 0})});
    const MeshReport report = inspect(mesh);
    EXPECT_EQ(report.component_count, 5U);
    EXPECT_TRUE(report.closed);
}

TEST(MeshReport, CountsDuplicateFacesInAnyOrderOfTheirCorners) {
    const TriangleMesh box = make_box({1, 1, 1});
    const Triangle f = box.faces[3];
    TriangleMesh mesh = with_face(with_face(box, {f[1], f[2], f[0]}), {f[2], f[1], f[0]});
    const MeshReport report = inspect(mesh);
    EXPECT_EQ(report.duplicate_faces.count, 2U);
    EXPECT_EQ(report.duplicate_faces.first_faces, (Faces{12, 13}));
    EXPECT_EQ(report.nonmanifold_edges.count, 3U);
    EXPECT_FALSE(report.manifold);
    EXPECT_TRUE(report.closed); // the two copies run opposite ways and cancel
}

TEST(MeshReport, CountsFacesWithoutAreaAsDegenerate) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                            {{0, 1, 3}, {0, 0, 1}, {0, 1, 2}, {1, 4, 3}}};
    const MeshReport report = inspect(mesh);
    EXPECT_EQ(report.degenerate_faces.count, 3U);
    EXPECT_EQ(report.degenerate_faces.first_faces, (Faces{1, 2, 3}));
}

TEST(MeshReport, StaysClosedWithANeedleOfZeroAreaInTheSurface) {
    // One edge of a tetrahedron has a vertex in its middle that only one of its two faces uses; the needle a
    // b m fills the slit of zero width.
    const TriangleMesh mesh{{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                            {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}}};
    const MeshReport report = inspect(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.degenerate_faces.first_faces, (Faces{3}));
    EXPECT_NEAR(report.signed_volume, 1.0 / 3, 1e-15);
}

TEST(MeshReport, ReportsAMeshWithAllPointsEqualAsDegenerateWithRadiusZero) {
    const MeshReport report = inspect({{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}, {{0, 1, 2}, {0, 0, 0}}});
    EXPECT_EQ(report.degenerate_faces.count, 2U);
    EXPECT_EQ(report.bounding_sphere.radius, 0);
}

TEST(MeshReport, NamesAtMostTheFirstFewFacesAscending) {
    TriangleMesh mesh = make_sphere(1, 20, 10);
    mesh.faces.resize(100);
    std::reverse(mesh.faces.begin(), mesh.faces.end());
    const MeshReport report = inspect(mesh);
    EXPECT_EQ(report.border_edges.count, 20U);
    EXPECT_EQ(report.border_edges.first_faces.size(), Fault::kFirstFaceCount);
    EXPECT_TRUE(
        std::is_sorted(report.border_edges.first_faces.begin(), report.border_edges.first_faces.end()));
}

TEST(MeshReport, TakesTheSphereOfUsedVerticesOnly) {
    TriangleMesh mesh = make_box({2, 2, 2});
    mesh.vertices.push_back({100, 0, 0});
    mesh.vertices.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    const MeshReport report = inspect(mesh);
    EXPECT_NEAR(report.bounding_sphere.radius, std::sqrt(3.0), 1e-15);
    EXPECT_EQ(report.vertex_count, 10U);
}

TEST(MeshReport, DoesNotDependOnTheOrderOfFacesAndVertices) {
    std::mt19937 random(7);
    TriangleMesh mesh = make_torus(1, 0.4, 20, 10);
    mesh.faces.resize(370);
    const MeshReport expected = inspect(mesh);
    std::vector<std::uint32_t> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    TriangleMesh shuffled{std::vector<Vec3f>(mesh.vertices.size()), mesh.faces};
    for (std::size_t i = 0; i < order.size(); ++i) shuffled.vertices[order[i]] = mesh.vertices[i];
    for (Triangle& face : shuffled.faces) face = {order[face[1]], order[face[2]], order[face[0]]};
    std::shuffle(shuffled.faces.begin(), shuffled.faces.end(), random);
    const MeshReport report = inspect(shuffled);
    EXPECT_EQ(report.closed, expected.closed);
    EXPECT_EQ(report.manifold, expected.manifold);
    EXPECT_EQ(report.border_edges.count, expected.border_edges.count);
    EXPECT_EQ(report.misoriented_edges.count, 0U);
    EXPECT_EQ(report.component_count, expected.component_count);
    EXPECT_NEAR(report.signed_volume, expected.signed_volume, 1e-12);
}

TEST(MeshReport, HandlesFlatAndHugeAndTinyMeshes) {
    for (const Vec3d size : {Vec3d{1, 1, 1e-6}, Vec3d{1e9, 1e9, 1e9}, Vec3d{1e-9, 1e-9, 1e-9}}) {
        const MeshReport report = inspect(make_box(size, 3));
        EXPECT_TRUE(report.closed);
        EXPECT_TRUE(report.manifold);
        EXPECT_EQ(report.degenerate_faces.count, 0U);
        const double expected = size.x * size.y * size.z;
        EXPECT_NEAR(report.signed_volume, expected, 2e-7 * expected);
        EXPECT_NEAR(report.bounding_sphere.radius, length(size) / 2, 1e-7 * length(size));
    }
}

TEST(MeshReport, RefusesWhatRequireValidRefuses) {
    expect_error(ErrorCode::InvalidMesh, "no faces", [] { inspect({}); });
    expect_error(ErrorCode::InvalidMesh, "face 0", [] { inspect({{{0, 0, 0}}, {{0, 0, 1}}}); });
}
