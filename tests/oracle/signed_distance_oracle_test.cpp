// Signed distances agree with CGAL: the side exactly, the distance to the rounding of lattice and float.

#include "judges/exact_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "oracle/test_meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace echinus;

namespace {

/// Anywhere in the bounding sphere, near the surface, and outside up to 30 000 radii.
std::vector<Vec3f> points_around(const TriangleMesh& mesh, const ExactMapView& map, std::size_t count) {
    std::vector<Vec3f> points = test::uniform_points(mesh, count);
    for (const Vec3f& p : test::surface_points(mesh, count)) points.push_back(p);
    test::Random random(7);
    for (float far = 1; far < 3e4F; far *= 2)
        for (std::size_t n = 0; n < count / 16; ++n)
            points.push_back(map.centre + test::unit_vector(random) * (far * map.radius));
    return points;
}

void expect_right(const std::string& name, const TriangleMesh& mesh) {
    const ExactMap map = ExactMap::build(mesh, {.rule = InsideRule::Parity}); // as the judge's
    const double radius = map.view().radius;
    const test::ExactJudge judge(mesh);
    const std::vector<Vec3f> points = points_around(mesh, map, 600);
    std::vector<float> found(points.size());
    signed_distance_batch(map, points, found);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = judge.distance(Vec3d(points[i]));
        const double tolerance = 4e-6 * radius + 1e-7 * distance;
        ASSERT_NEAR(std::fabs(found[i]), distance, tolerance) << name << ", point " << i;
        if (distance > tolerance)
            ASSERT_EQ(std::signbit(found[i]), judge.inside(points[i])) << name << ", point " << i;
    }
}

} // namespace

TEST(SignedDistanceOracle, IsRightAboutGeneratedMeshes) {
    for (const auto& [name, mesh] : test::generated_meshes()) expect_right(name, mesh);
}

TEST(SignedDistanceOracle, IsRightAboutNastyMeshes) {
    for (const std::string& name : test::nasty_mesh_names())
        if (name != "million" && name != "rings") // too slow for a test
            expect_right(name, test::make_nasty_mesh(name));
}
