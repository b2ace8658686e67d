#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/tetrahedra.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace echinus;
using namespace echinus::test;

namespace {

/// The bounds, and a twentieth of a degree for the rounding of vertices to float.
constexpr double kLeastAngle = 9.25, kGreatestAngle = 161.75;

Tetrahedralization tetrahedralize_mesh(const TriangleMesh& mesh, TetrahedralizeOptions options) {
    const ExactMap map = ExactMap::build(mesh);
    return tetrahedralize(map, options);
}

/// Positive tetrahedra whose volumes add up to what their boundary encloses, and a boundary that does not
/// intersect itself: so they overlap nowhere.
TetrahedralReport expect_good_body(const TetrahedralMesh& mesh) {
    const TetrahedralReport report = inspect_tetrahedra(mesh); // throws unless all are positive
    EXPECT_EQ(report.vertex_count, mesh.vertices.size());
    EXPECT_GT(report.least_volume, 0);
    EXPECT_GE(report.least_angle_deg, kLeastAngle);
    EXPECT_LE(report.greatest_angle_deg, kGreatestAngle);
    EXPECT_TRUE(report.boundary.closed);
    EXPECT_TRUE(report.boundary.manifold);
    EXPECT_NEAR(report.boundary.signed_volume, report.volume, 1e-9 * report.volume);
    EXPECT_TRUE(self_intersecting_pairs(boundary(mesh)).empty());
    return report;
}

TriangleMesh two_spheres() {
    return joined({make_sphere(1, 40, 20), translated(make_sphere(0.8, 30, 15), {1.1F, 0.2F, 0.1F})});
}

} // namespace

TEST(Tetrahedralize, FillsASphereATorusABoxAPlateAndSpheresThatOverlap) {
    const TriangleMesh models[] = {make_sphere(1, 60, 30), make_torus(1, 0.4, 60, 24),
                                   make_box({1, 2, 0.7}, 2), make_box({2, 2, 0.2}, 4), two_spheres()};
    for (const TriangleMesh& model : models)
        for (const double size : {0.23, 0.12, 0.061}) {
            SCOPED_TRACE(size);
            expect_good_body(tetrahedralize_mesh(model, {.size = size}).mesh);
        }
}

TEST(Tetrahedralize, FillsABoxAsMuchWhenPlanesThroughItsCentreCutItIntoParts) {
    for (const std::size_t count : {500U, 4000U}) {
        const TetrahedralizeOptions options{.count = count};
        const double whole =
            inspect_tetrahedra(tetrahedralize_mesh(make_box({2, 2, 2}), options).mesh).volume;
        for (const TriangleMesh& model : {make_two_wedges(), make_four_wedges()})
            EXPECT_NEAR(expect_good_body(tetrahedralize_mesh(model, options).mesh).volume, whole, 1e-3);
    }
}

TEST(Tetrahedralize, MeetsTheAnglesWhateverTheSurface) {
    // Features finer than the lattice: nearly every pattern of sides and every place of a cut occurs.
    Random random(5);
    TriangleMesh crowd;
    for (int i = 0; i < 150; ++i) {
        const double radius = uniform(random, 0.02F, 0.2F);
        crowd = joined({crowd, translated(make_sphere(radius, 7, 5), in_cube(random, 1))});
    }
    std::size_t removed = 0;
    for (const double size : {0.3, 0.17, 0.1, 0.06}) {
        SCOPED_TRACE(size);
        const Tetrahedralization body = tetrahedralize_mesh(crowd, {.size = size});
        expect_good_body(body.mesh);
        removed += body.removed_tetrahedra;
    }
    EXPECT_GT(removed, 0U) << "the test has no place where parts meet in a vertex";
}

TEST(Tetrahedralize, FillsOpenSurfacesByTheirWindingNumber) {
    for (const double size : {0.2, 0.1})
        expect_good_body(tetrahedralize_mesh(exploded(make_sphere(1, 24, 12), 0.9F), {.size = size}).mesh);
}

TEST(Tetrahedralize, PutsTheBoundaryOnTheModel) {
    const TriangleMesh model = make_torus(1, 0.4, 60, 24);
    const double size = 0.15;
    const Tetrahedralization body = tetrahedralize_mesh(model, {.size = size});
    ASSERT_EQ(body.removed_tetrahedra, 0U);
    EXPECT_EQ(body.size, size);
    const TriangleMesh surface = boundary(body.mesh);
    for (const Triangle& face : surface.faces)
        for (const std::uint32_t vertex : face)
            ASSERT_LT(unsigned_distance(model, Vec3d(surface.vertices[vertex])), 1e-5);
}

TEST(Tetrahedralize, ConvergesToTheVolumeOfASphere) {
    const TriangleMesh model = make_sphere(1, 400, 200);
    const ExactMap map = ExactMap::build(model);
    const double volume = inspect(model).signed_volume;
    double last_error = 1;
    for (const double size : {0.4, 0.2, 0.1}) {
        const double error =
            std::abs(inspect_tetrahedra(tetrahedralize(map, {.size = size}).mesh).volume - volume) / volume;
        EXPECT_LT(error, last_error / 3) << size; // chords: a quarter at half the size
        last_error = error;
    }
    EXPECT_LT(last_error, 0.005);
}

TEST(Tetrahedralize, MeetsACount) {
    const ExactMap map = ExactMap::build(two_spheres());
    for (const std::size_t count : {500U, 5'000U, 50'000U}) {
        const Tetrahedralization body = tetrahedralize(map, {.count = count});
        EXPECT_NEAR(static_cast<double>(body.mesh.tetrahedra.size()), static_cast<double>(count),
                    0.05 * count);
        EXPECT_EQ(tetrahedralize(map, {.size = body.size}).mesh.tetrahedra, body.mesh.tetrahedra);
    }
}

TEST(Tetrahedralize, PrefersTooManyTetrahedraToNone) {
    const ExactMap map = ExactMap::build(make_sphere(1, 40, 20));
    for (const std::size_t count : {1U, 5U})
        EXPECT_LT(tetrahedralize(map, {.count = count}).mesh.tetrahedra.size(), 200U) << count;
}

TEST(Tetrahedralize, GivesTheSameBytesForAnyNumberOfThreads) {
    const ExactMap map = ExactMap::build(two_spheres());
    const TetrahedralMesh one = tetrahedralize(map, {.size = 0.07, .thread_count = 1}).mesh;
    for (const unsigned thread_count : {2U, 3U, 7U}) {
        const TetrahedralMesh other = tetrahedralize(map, {.size = 0.07, .thread_count = thread_count}).mesh;
        EXPECT_EQ(other.vertices, one.vertices);
        EXPECT_EQ(other.tetrahedra, one.tetrahedra);
    }
}

TEST(Tetrahedralize, DoesNotMindFarPlacesAndSmallSizes) {
    for (const float scale : {1e-6F, 1e6F}) {
        TriangleMesh model = make_torus(1, 0.4, 20, 12);
        for (Vec3f& vertex : model.vertices) vertex = (vertex + Vec3f{30, -20, 10}) * scale;
        expect_good_body(tetrahedralize_mesh(model, {.size = 0.2 * double{scale}}).mesh);
    }
}

TEST(Tetrahedralize, ReportsProgressUpToTheEnd) {
    const ExactMap map = ExactMap::build(make_sphere(1, 20, 10));
    std::vector<double> shares;
    tetrahedralize(map, {.size = 0.1, .progress = [&](double share) { shares.push_back(share); }});
    ASSERT_FALSE(shares.empty());
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

TEST(Tetrahedralize, RefusesWhatItCannotDo) {
    const ExactMap map = ExactMap::build(make_sphere(1, 20, 10));
    const auto expect_refused = [&](const std::string& words, const TetrahedralizeOptions& options) {
        expect_error(ErrorCode::InvalidOptions, words, [&] { tetrahedralize(map, options); });
    };
    expect_refused("either the size", {});
    expect_refused("either the size", {.size = 1, .count = 1});
    expect_refused("finite and positive", {.size = -1});
    expect_refused("finite and positive", {.size = std::nan("")});
    expect_refused("more tetrahedra than the limit of 1000", {.size = 0.1, .most_tetrahedra = 1000});
    expect_refused("2000 tetrahedra are more than the limit", {.count = 2000, .most_tetrahedra = 1000});
    expect_refused("too small for coordinates of up to 1", {.size = 1e-4});
    expect_refused("vertices, more than the limit", {.size = 0.001});
    expect_error(ErrorCode::InvalidMesh, "choose a smaller size", [] {
        tetrahedralize_mesh(make_box({2, 2, 0.001}), {.size = 0.33});
    });
    // Sizes at which such a plate has elements at all make millions of them.
    expect_error(ErrorCode::InvalidMesh, "at which about 500 tetrahedra fit into the model", [] {
        tetrahedralize_mesh(make_box({2, 2, 0.001}), {.count = 500});
    });
}
