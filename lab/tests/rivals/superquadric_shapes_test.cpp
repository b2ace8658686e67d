// Superquadric maps of shapes that designers make. They are approximate: what is asked is what holds all the
// same.

#include "property/shape_judge.hpp"
#include "property/shape_parts.hpp"
#include "property/shapes.hpp"
#include "rivals/superquadric_map/superquadric_map.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

using namespace echinus;
using namespace echinus::test;
using rivals::SuperquadricMap;

namespace {

SuperquadricMap make_map(const TriangleMesh& mesh, std::uint32_t segment_count) {
    rivals::SuperquadricMapOptions options;
    options.segment_count = segment_count;
    options.omega_count = 60;
    options.eta_count = 40;
    options.decomposition_face_limit = 300; // for the sake of time
    options.thread_count = 1;
    return SuperquadricMap::build(mesh, options);
}

std::vector<Vec3f> points_around(const TriangleMesh& mesh, std::size_t count, Choices& choices) {
    const Sphere sphere = inspect(mesh).bounding_sphere;
    std::vector<Vec3f> points;
    while (points.size() < count) {
        const auto coordinate = [&] { return choices.within(-1.3, 1.3) * sphere.radius; };
        const double x = coordinate(), y = coordinate();
        points.emplace_back(Vec3d(sphere.centre) + Vec3d{x, y, coordinate()});
    }
    return points;
}

bool is_convex(const TriangleMesh& mesh) {
    const double tolerance = 1e-5 * inspect(mesh).bounding_sphere.radius;
    return std::ranges::all_of(mesh.faces, [&](const Triangle& face) {
        const Vec3d a(mesh.vertices[face[0]]), b(mesh.vertices[face[1]]), c(mesh.vertices[face[2]]);
        const Vec3d normal = cross(b - a, c - a);
        return std::ranges::all_of(mesh.vertices, [&](const Vec3f& v) {
            return dot(normal, Vec3d(v) - a) <= tolerance * length(normal);
        });
    });
}

} // namespace

TEST(SuperquadricShapes, HaveNothingInsideThatIsFarBeyondTheirBox) {
    std::size_t map_count = 0;
    for (std::uint64_t seed = 1; map_count < 12; ++seed) {
        const Shape shape = make_shape(seed);
        if (shape.mesh.faces.size() > 100) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + shape.recipe);
        ++map_count;
        const SuperquadricMap map = make_map(shape.mesh, 0);
        const Box box = box_of(shape.mesh);
        const double radius = inspect(shape.mesh).bounding_sphere.radius;
        Choices choices(seed);
        const std::vector<Vec3f> points = points_around(shape.mesh, 400, choices);
        std::vector<std::uint8_t> inside(points.size());
        map.contains_batch(points, inside);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Vec3f& p = points[i];
            const Contact found = map.contact(p, static_cast<float>(radius));
            ASSERT_EQ(map.contains(p), inside[i] != 0);
            ASSERT_EQ(found.inside, inside[i] != 0);
            if (found.found()) ASSERT_NEAR(length(found.normal), 1, 1e-4);
            ASSERT_TRUE(is_finite(found.point));
            const Vec3f low = box.low - p, high = p - box.high;
            const double beyond = std::max({low.x, low.y, low.z, high.x, high.y, high.z});
            if (found.inside) ASSERT_LT(beyond, 0.2 * radius) << p.x << " " << p.y << " " << p.z;
        }
    }
}

TEST(SuperquadricShapes, AreOnTheRightSideOfAConvexOneButNearItsEdges) {
    std::size_t map_count = 0, point_count = 0, wrong_count = 0;
    for (std::uint64_t seed = 270; map_count < 25; ++seed) {
        const Shape shape = make_shape(seed);
        if (!is_convex(shape.mesh)) continue;
        SCOPED_TRACE("seed " + std::to_string(seed) + ", " + shape.recipe);
        ++map_count;
        const double radius = inspect(shape.mesh).bounding_sphere.radius;
        const SuperquadricMap map = make_map(shape.mesh, 1);
        const ShapeJudge judge(shape.mesh, 1e-5 * radius);
        Choices choices(seed);
        for (const Vec3f& p : points_around(shape.mesh, 400, choices)) {
            const std::optional<int> winding = judge.winding(Vec3d(p));
            if (!winding) continue;
            ++point_count;
            if (map.contains(p) == (*winding != 0)) continue;
            ++wrong_count;
            ASSERT_LT(judge.distance(Vec3d(p)), 0.4 * radius) << p.x << " " << p.y << " " << p.z;
        }
    }
    EXPECT_LT(wrong_count, point_count / 200);
}
