#include "directions/face_cone.hpp"
#include "rivals/superquadric_map/decompose.hpp"
#include "rivals/superquadric_map/segments.hpp"
#include "rivals/superquadric_map/superquadric.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::rivals;
using test::joined;
using test::PortableRandom;
using test::translated;

namespace {

TriangleMesh row_of_boxes(int count, float gap) {
    TriangleMesh row;
    for (int i = 0; i < count; ++i)
        row = joined({row, translated(make_box({1, 1, 1}, 2), {static_cast<float>(i) * (1 + gap), 0, 0})});
    return row;
}

std::size_t segments_of(const Decomposition& decomposition, std::size_t first_face, std::size_t face_count) {
    const auto begin = decomposition.segment_of_face.begin() + static_cast<std::ptrdiff_t>(first_face);
    return std::set<std::uint32_t>(begin, begin + static_cast<std::ptrdiff_t>(face_count)).size();
}

void expect_numbered(const Decomposition& decomposition, std::size_t face_count) {
    ASSERT_EQ(decomposition.segment_of_face.size(), face_count);
    std::uint32_t known = 0;
    for (const std::uint32_t segment : decomposition.segment_of_face) {
        ASSERT_LE(segment, known);
        known = std::max(known, segment + 1);
    }
    EXPECT_EQ(known, decomposition.segment_count);
}

} // namespace

TEST(Simplify, KeepsASurfaceClosedAndNearToWhatItWas) {
    for (const TriangleMesh& mesh : {make_sphere(1, 60, 30), make_torus(1, 0.4, 60, 24)}) {
        const SimplifiedMesh simplified = simplify(mesh, 600);
        EXPECT_LE(simplified.mesh.faces.size(), 600U);
        EXPECT_GT(simplified.mesh.faces.size(), 500U);
        const MeshReport before = inspect(mesh), after = inspect(simplified.mesh);
        EXPECT_TRUE(after.closed && after.manifold);
        EXPECT_EQ(after.degenerate_faces.count, 0U);
        EXPECT_NEAR(after.signed_volume, before.signed_volume, 0.05 * before.signed_volume);
    }
}

TEST(Simplify, TakesAwayFlatPartsFirst) {
    const SimplifiedMesh simplified = simplify(make_box({1, 2, 3}, 10), 60); // of 1200
    EXPECT_LE(simplified.mesh.faces.size(), 60U);
    EXPECT_NEAR(inspect(simplified.mesh).signed_volume, 6, 1e-5);
}

TEST(Simplify, StopsWhereTheTopologyWouldChange) {
    const TriangleMesh parts = row_of_boxes(5, 1);
    const SimplifiedMesh simplified = simplify(parts, 4);
    EXPECT_TRUE(inspect(simplified.mesh).closed);
    EXPECT_EQ(inspect(simplified.mesh).component_count, 5U);
    EXPECT_GE(inspect(simplified.mesh).signed_volume, 0.5);
}

TEST(Simplify, SaysWhichFacesAreLeftAndLeavesOutThoseWithoutArea) {
    TriangleMesh mesh = make_sphere(1, 12, 6);
    mesh.faces.insert(mesh.faces.begin(), {3, 3, 4});
    const SimplifiedMesh simplified = simplify(mesh, 1000);
    ASSERT_EQ(simplified.mesh.faces.size(), mesh.faces.size() - 1);
    for (std::size_t i = 0; i < simplified.face_numbers.size(); ++i) {
        EXPECT_EQ(simplified.face_numbers[i], i + 1);
        EXPECT_EQ(simplified.mesh.faces[i], mesh.faces[i + 1]);
    }
}

TEST(Decompose, ReachesTheNumberOfSegmentsThatIsAskedFor) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 8);
    for (const std::uint32_t count : {1U, 2U, 12U, 17U}) {
        const Decomposition decomposition = decompose(torus, {.segment_count = count});
        EXPECT_EQ(decomposition.segment_count, count);
        expect_numbered(decomposition, torus.faces.size());
    }
}

TEST(Decompose, LeavesAConvexSolidWholeAndCutsATorusTheFinerTheLessConcavityIsAllowed) {
    EXPECT_EQ(decompose(make_sphere(1, 16, 8), {}).segment_count, 1U);
    EXPECT_EQ(decompose(make_box({3, 1, 2}, 4), {}).segment_count, 1U);
    std::uint32_t coarser = 1;
    for (const double concavity : {0.2, 0.05, 0.02}) {
        const std::uint32_t count =
            decompose(make_torus(1, 0.4, 20, 8), {.concavity = concavity}).segment_count;
        EXPECT_GT(count, coarser);
        coarser = count;
    }
}

TEST(Decompose, KeepsPartsThatAreFarFromEachOtherApartWhateverIsAskedFor) {
    const Decomposition decomposition = decompose(row_of_boxes(3, 2), {.segment_count = 1});
    EXPECT_EQ(decomposition.segment_count, 3U);
    const std::size_t faces_each = decomposition.segment_of_face.size() / 3;
    for (std::size_t part = 0; part < 3; ++part)
        EXPECT_EQ(segments_of(decomposition, part * faces_each, faces_each), 1U);
}

TEST(Decompose, GivesEveryFaceOfAMeshThatHadToBeSimplifiedASegment) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    const Decomposition decomposition = decompose(torus, {.segment_count = 5, .face_limit = 400});
    EXPECT_EQ(decomposition.segment_count, 5U);
    expect_numbered(decomposition, torus.faces.size());
    std::vector<std::size_t> counts(5);
    for (const std::uint32_t segment : decomposition.segment_of_face) ++counts[segment];
    EXPECT_GT(std::ranges::min(counts), 20U);
}

TEST(Decompose, GivesFacesWithoutAreaASegmentToo) {
    TriangleMesh mesh = make_sphere(1, 12, 6);
    mesh.faces.push_back({3, 3, 4});
    mesh.faces.insert(mesh.faces.begin(), {5, 5, 5});
    expect_numbered(decompose(mesh, {}), mesh.faces.size());
}

TEST(Decompose, RefusesWhatWouldTakeTooLong) {
    test::expect_error(ErrorCode::InvalidMesh, "too long",
                       [] { (void)decompose(row_of_boxes(20, 1), {.face_limit = 10}); });
    TriangleMesh points{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}, {1, 0, 0}}};
    test::expect_error(ErrorCode::InvalidMesh, "area", [&] { (void)decompose(points, {}); });
}

TEST(Decompose, TellsOfItsProgressAndHandsOnWhatTheListenerThrows) {
    double last = 0;
    const TriangleMesh mesh = make_torus(1, 0.4, 30, 12);
    (void)decompose(mesh, {.segment_count = 2}, [&](std::string_view stage, double share) {
        if (stage != "decompose") return;
        EXPECT_TRUE(share >= 0 && share <= 1);
        last = std::max(last, share);
    });
    EXPECT_GT(last, 0.9);
    EXPECT_THROW(
        (void)decompose(mesh, {}, [](std::string_view, double) { throw std::runtime_error("stop"); }),
        std::runtime_error);
}

TEST(ConvexHull, HoldsAllPointsAndIsClosed) {
    PortableRandom random(3);
    TriangleMesh hull;
    for (int i = 0; i < 300; ++i)
        hull.vertices.emplace_back(static_cast<float>(random.uniform(5, 8)),
                                   static_cast<float>(random.uniform(-1, 1)),
                                   static_cast<float>(random.uniform(-2, 2)));
    hull.faces = convex_hull(hull.vertices);
    const MeshReport report = inspect(hull);
    EXPECT_TRUE(report.closed);
    EXPECT_NEAR(std::fabs(report.signed_volume), 24, 5); // a bit less than the box
    EXPECT_LT(std::fabs(report.signed_volume), 24);
    for (const Triangle& face : hull.faces) {
        const Vec3d a(hull.vertices[face[0]]), b(hull.vertices[face[1]]), c(hull.vertices[face[2]]);
        const Vec3d normal = cross(b - a, c - a) * (1 / length(cross(b - a, c - a)));
        for (const Vec3f& p : hull.vertices) EXPECT_LT(dot(normal, Vec3d(p) - a), 1e-3);
    }
}

TEST(ConvexHull, OfABoxHasTwelveFacesWhateverIsInside) {
    TriangleMesh box = make_box({1, 2, 3}, 4);
    box.vertices.emplace_back(0.1F, 0.2F, 0.3F);
    const std::vector<Triangle> faces = convex_hull(box.vertices);
    EXPECT_NEAR(std::fabs(inspect({box.vertices, faces}).signed_volume), 6, 1e-5);
    EXPECT_TRUE(convex_hull(std::vector<Vec3f>(5, Vec3f{1, 2, 3})).empty());
}

TEST(Segments, HaveTheirOwnFacesAndTheHullsOfThem) {
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    const Decomposition decomposition = decompose(torus, {.segment_count = 6});
    const std::vector<Segment> segments = make_segments(torus, decomposition);
    ASSERT_EQ(segments.size(), 6U);
    std::size_t faces = 0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const Segment& segment = segments[i];
        faces += segment.face_numbers.size();
        for (std::size_t k = 0; k < segment.face_numbers.size(); ++k) {
            EXPECT_EQ(decomposition.segment_of_face[segment.face_numbers[k]], i);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_EQ(segment.mesh.vertices[segment.own_faces()[k][c]],
                          torus.vertices[torus.faces[segment.face_numbers[k]][c]]);
        }
        const std::span<const Triangle> hull = segment.hull_faces();
        EXPECT_TRUE(inspect({segment.mesh.vertices, {hull.begin(), hull.end()}}).closed);
    }
    EXPECT_EQ(faces, torus.faces.size());
}

TEST(SurfaceSamples, AreAsManyPerAreaEverywhere) {
    const TriangleMesh box = make_box({4, 2, 1});
    const SurfaceSamples samples = sample_surface(box.vertices, box.faces, 2800);
    EXPECT_NEAR(samples.area, 28, 1e-5);
    ASSERT_EQ(samples.points.size(), 2800U);
    std::size_t on_top = 0, on_right_of_top = 0;
    for (const Vec3d& p : samples.points) {
        if (std::fabs(p.z - 0.5) > 1e-6) continue;
        ++on_top;
        on_right_of_top += p.x > 0 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(on_top), 800, 2);
    EXPECT_NEAR(static_cast<double>(on_right_of_top), 400, 8);
}

TEST(OutermostCrossings, AreThoseOfATestOfEveryRayWithEveryFace) {
    // The search for rays near a face must miss none, wherever exponents and sizes draw the samples.
    const TriangleMesh mesh = make_torus(1, 0.4, 20, 10);
    const SphericalGrid grid(31, 18, PoleAxis::Z);
    for (const double e1 : {0.1, 0.8, 2.0})
        for (const double e2 : {0.1, 1.0, 1.7}) {
            Superquadric shape;
            shape.rotation = Rotation::about({1, 2, 3}, 0.9);
            shape.sizes = {1, 0.3, 2};
            shape.eta_exponent = e1;
            shape.omega_exponent = e2;
            const LatticeMesh lattice = snap_to_lattice(mesh, {1, 0.1F, 0.05F});
            const std::vector<Vec3d> points = sample_points(shape, grid);
            const std::size_t own_faces = 300;
            const std::vector<float> found = outermost_crossings(lattice, own_faces, shape, grid, points);
            std::size_t hits = 0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const LatticePoint d =
                    lattice_direction(shape.rotation.apply(points[i] * (1 / length(points[i]))));
                double own = -1, other = -1;
                for (std::uint32_t face = 0; face < lattice.faces.size(); ++face) {
                    const auto [a, b, c] = lattice.corners(face);
                    const FaceCone cone(a, b, c);
                    if (cone.edge_on() || !cone.meets(d)) continue;
                    double& farthest = lattice.face_numbers[face] < own_faces ? own : other;
                    farthest = std::max(farthest, cone.parameter(d) * length(Vec3d(d)) * lattice.frame.step);
                }
                ASSERT_EQ(found[i], static_cast<float>(own < 0 ? other : own)) << i << " " << e1 << " " << e2;
                hits += found[i] >= 0 ? 1 : 0;
            }
            EXPECT_EQ(hits, points.size()); // from within
        }
}
