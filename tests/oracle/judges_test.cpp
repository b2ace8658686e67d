#include "directions/cast_rays.hpp"
#include "judges/crossing_counter.hpp"
#include "judges/exact_judge.hpp"
#include "judges/judge_trees.hpp"
#include "judges/nasty_meshes.hpp"
#include "support/point_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace echinus;

TEST(JudgesOracle, WindingNumberAgreesWithCgalOnTheSide) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        for (const auto& points : {test::uniform_points(mesh, 300), test::surface_points(mesh, 300)})
            for (const Vec3f& p : points) {
                if (judge.side(Vec3d(p)) == test::ExactSide::OnSurface) continue;
                ASSERT_NEAR(winding_number(mesh, Vec3d(p)), judge.inside(p) ? 1 : 0, 1e-9) << name;
            }
    }
}

TEST(JudgesOracle, UnsignedDistanceAgreesWithCgal) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        for (const auto& points : {test::uniform_points(mesh, 300), test::surface_points(mesh, 300)})
            for (const Vec3f& p : points)
                ASSERT_NEAR(unsigned_distance(mesh, Vec3d(p)), judge.distance(Vec3d(p)), 1e-12) << name;
    }
}

TEST(JudgesOracle, RecognisesTheSurface) {
    const test::ExactJudge judge(make_box({2, 2, 2}));
    EXPECT_EQ(judge.side({1, 0.25, 0.5}), test::ExactSide::OnSurface);
    EXPECT_EQ(judge.side({1, 1, 1}), test::ExactSide::OnSurface);
    EXPECT_EQ(judge.side({1 + 1e-15, 0.25, 0.5}), test::ExactSide::Outside);
    EXPECT_EQ(judge.side({1 - 1e-15, 0.25, 0.5}), test::ExactSide::Inside);
}

namespace {

std::vector<test::Corners> corners_of(const TriangleMesh& mesh) {
    std::vector<test::Corners> corners;
    for (const auto& [a, b, c] : mesh.faces)
        corners.push_back({Vec3d(mesh.vertices[a]), Vec3d(mesh.vertices[b]), Vec3d(mesh.vertices[c])});
    return corners;
}

double unit_of(const TriangleMesh& mesh) {
    return inspect(mesh).bounding_sphere.radius * 0x1p-19;
}

} // namespace

TEST(CrossingCounter, CountsWindingNumbersOfOverlappingNestedAndInvertedParts) {
    const TriangleMesh parts =
        test::joined({make_sphere(1, 24, 12), test::translated(make_sphere(1, 24, 12), {0.5F, 0, 0}),
                      test::turned_inside_out(make_sphere(0.6, 24, 12)),
                      test::turned_inside_out(make_box({5, 0.3, 0.3}))});
    const test::CrossingCounter counter(corners_of(parts), unit_of(parts), test::OnPlane::Skip);
    for (const Vec3f& p : test::uniform_points(parts, 2000))
        ASSERT_NEAR(counter.winding(Vec3d(p)), winding_number(parts, Vec3d(p)), 1e-9);
}

TEST(CrossingCounter, IsRightOnTheExtensionsOfFacesAndEdges) {
    const TriangleMesh box = make_box({2, 2, 2}, 2);
    const test::CrossingCounter counter(corners_of(box), unit_of(box), test::OnPlane::Skip);
    for (const Vec3d& p : {Vec3d{1, 1, 1.5}, Vec3d{1, 0, -1.5}, Vec3d{1.5, 1, 0}, Vec3d{0.5, 1, -2}})
        EXPECT_EQ(counter.winding(p), 0);
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0, 0.5, 0}, Vec3d{0, 0.25, 0.25}})
        EXPECT_EQ(counter.winding(p), 1);
}

// A particle on the surface counts as displaced by (e, e^2, e^3): an axis-aligned box therefore owns its
// lower sides, and no neighbour owns them as well.
TEST(CrossingCounter, DisplacesWhatLiesOnTheSurface) {
    const TriangleMesh box = make_box({4, 4, 4}, 2);
    const test::CrossingCounter counter(corners_of(box), 1, test::OnPlane::Displace);
    const auto owns = [](double coordinate) { return coordinate >= -2 && coordinate < 2; };
    for (double x = -3; x <= 3; ++x)
        for (double y = -3; y <= 3; ++y)
            for (double z = -3; z <= 3; ++z)
                EXPECT_EQ(counter.winding({x, y, z}), owns(x) && owns(y) && owns(z) ? 1 : 0)
                    << x << ", " << y << ", " << z;
}

TEST(CrossingCounter, DisplacesAlongYWhereXDecidesNothing) {
    // A plane that contains the x axis: y = z. Since e^2 > e^3, a particle on it moves to the side of larger
    // y.
    TriangleMesh wedge;
    wedge.vertices = {{-8, -8, -8}, {8, -8, -8}, {8, 8, 8}, {-8, 8, 8}, {0, 8, -8}};
    wedge.faces = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    if (inspect(wedge).signed_volume < 0) wedge = test::turned_inside_out(wedge);
    const test::CrossingCounter counter(corners_of(wedge), 1, test::OnPlane::Displace);
    EXPECT_EQ(counter.winding({1, 2, 2}), 1);
    EXPECT_EQ(counter.winding({1, 2, 3}), 0);
    EXPECT_EQ(counter.winding({1, 3, 2}), 1);
}

TEST(CrossingCounter, FindsAnotherRayWhereTheFirstEndsOnThePlaneOfAFace) {
    constexpr double kRadius = 524288;
    TriangleMesh octahedron = make_sphere(kRadius, 4, 2);
    const test::CrossingCounter counter(corners_of(octahedron), 1, test::OnPlane::Displace);
    // The first ray ends on x + y - z = kRadius, the plane of a face.
    const double difference = 1299709 + 1999993 - 2750159 - kRadius;
    EXPECT_EQ(counter.winding({-60000, 30000, difference - 30000}), 1);
}

TEST(DistanceTree, GivesTheDistancesOfCgalWhateverTheHint) {
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const test::ExactJudge judge(mesh);
        const test::DistanceTree tree(corners_of(mesh));
        const auto last = static_cast<std::uint32_t>(mesh.faces.size() - 1);
        for (const auto& points : {test::uniform_points(mesh, 300), test::surface_points(mesh, 300)})
            for (const Vec3f& p : points) {
                ASSERT_NEAR(tree.distance(Vec3d(p)), judge.distance(Vec3d(p)), 1e-12) << name;
                ASSERT_EQ(tree.distance(Vec3d(p), last), tree.distance(Vec3d(p))) << name;
            }
    }
}

TEST(SolidAngleTree, GivesTheWindingNumberOfOpenSurfaces) {
    TriangleMesh open = test::joined({make_sphere(1, 40, 20), test::turned(make_box({1, 1, 3}, 6))});
    std::erase_if(open.faces, [&](const Triangle& face) { return (face[0] * 7 + face[1]) % 5 == 0; });
    const test::SolidAngleTree tree(open);
    for (const auto& points : {test::uniform_points(open, 500), test::surface_points(open, 500)})
        for (const Vec3f& p : points)
            ASSERT_NEAR(tree.winding_number(Vec3d(p)), winding_number(open, Vec3d(p)), 1e-9);
}

namespace {

test::ExactRayCaster caster_for(const LatticeMesh& lattice) {
    std::vector<std::array<Vec3d, 3>> faces;
    for (const auto& [a, b, c] : lattice.faces)
        faces.push_back({Vec3d(lattice.vertices[a]), Vec3d(lattice.vertices[b]), Vec3d(lattice.vertices[c])});
    return test::ExactRayCaster(faces);
}

struct RayCounts {
    int all = 0, degenerate = 0;
};

/// Casts every ray of a grid with CGAL and calls `check(direction, exact crossings, length of the lattice
/// direction in the mesh's unit)`.
template <typename Check>
RayCounts for_each_ray(const LatticeMesh& lattice, const SphericalGrid& grid, Check check) {
    const test::ExactRayCaster caster = caster_for(lattice);
    RayCounts counts;
    std::size_t direction = 0;
    for (const Vec3d& unit : grid.directions()) {
        const Vec3d d(lattice_direction(unit));
        const test::ExactCrossings exact = caster.cast(d);
        check(direction++, exact, length(d) * lattice.frame.step);
        ++counts.all;
        counts.degenerate += !exact.generic;
    }
    return counts;
}

constexpr PoleAxis kAxes[] = {PoleAxis::X, PoleAxis::Y, PoleAxis::Z};

} // namespace

TEST(CrossingsOracle, CountsAsCgalDoesOnEveryRayEvenThroughEdgesAndVertices) {
    RayCounts total;
    for (const auto& [name, mesh] : test::generated_meshes())
        for (PoleAxis axis : kAxes) {
            const LatticeMesh lattice = snap_to_lattice(mesh);
            const SphericalGrid grid(24, 12, axis);
            const Crossings crossings = cast_rays(lattice, grid, 1);
            const RayCounts counts =
                for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double) {
                    ASSERT_EQ(crossings.offsets[d + 1] - crossings.offsets[d], exact.parameters.size())
                        << name << ", direction " << d << (exact.generic ? "" : ", degenerate");
                });
            total.all += counts.all;
            total.degenerate += counts.degenerate;
        }
    EXPECT_GT(total.degenerate, 500);
    EXPECT_GT(total.all, 2 * total.degenerate);
}

TEST(CrossingsOracle, DistancesAgreeWithCgalUpToTheRoundingOfFloat) {
    constexpr double kFloatRounding = 0x1p-24;
    for (const auto& [name, mesh] : test::generated_meshes()) {
        const LatticeMesh lattice = snap_to_lattice(mesh);
        const SphericalGrid grid(40, 21, PoleAxis::Y);
        const Crossings crossings = cast_rays(lattice, grid, 1);
        for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double unit) {
            for (std::size_t k = 0; k < exact.parameters.size(); ++k) {
                const double expected = std::min(exact.parameters[k] * unit, double{lattice.radius});
                ASSERT_NEAR(crossings.distances[crossings.offsets[d] + k], expected,
                            expected * kFloatRounding * 1.001)
                    << name << ", direction " << d << ", crossing " << k;
            }
        });
    }
}

TEST(CrossingsOracle, AgreesOnRandomDirectionsOfAFineMesh) {
    // An odd grid and a turned mesh: no ray is degenerate, and every count is CGAL's own on the plain ray.
    const LatticeMesh lattice = snap_to_lattice(test::turned(make_torus(1, 0.45, 120, 48)));
    const SphericalGrid grid(61, 37, PoleAxis::X);
    const Crossings crossings = cast_rays(lattice, grid, 1);
    const RayCounts counts =
        for_each_ray(lattice, grid, [&](std::size_t d, const test::ExactCrossings& exact, double) {
            ASSERT_EQ(crossings.offsets[d + 1] - crossings.offsets[d], exact.parameters.size());
        });
    EXPECT_EQ(counts.degenerate, 0);
}
