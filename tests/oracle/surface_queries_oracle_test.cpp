// Queries of triangles agree with CGAL: intersections exactly, distances to rounding.

#include "directions/lattice.hpp"
#include "judges/intersection_judge.hpp"
#include "oracle/test_meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/surface_queries.hpp>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

using namespace echinus;
using namespace echinus::test;

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using QueryCorners = std::array<Vec3d, 3>;

Kernel::Point_3 to_cgal(const Vec3d& p) {
    return {p.x, p.y, p.z};
}

QueryCorners in_double(const TrianglePoints& t) {
    return {Vec3d(t[0]), Vec3d(t[1]), Vec3d(t[2])};
}

/// In exact arithmetic: of two triangles that do not meet, edges are nearest or a corner and a face.
double distance_by_cgal(const QueryCorners& a, const QueryCorners& b) {
    std::array<Kernel::Point_3, 3> p, q;
    for (std::size_t k = 0; k < 3; ++k) {
        p[k] = to_cgal(a[k]);
        q[k] = to_cgal(b[k]);
    }
    Kernel::FT least = std::numeric_limits<double>::max();
    const auto offer = [&](const Kernel::FT& candidate) { least = std::min(least, candidate); };
    const auto edge = [](const std::array<Kernel::Point_3, 3>& t, std::size_t k) {
        return Kernel::Segment_3(t[k], t[(k + 1) % 3]);
    };
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) offer(CGAL::squared_distance(edge(p, i), edge(q, j)));
    for (const auto& [corners, others] : {std::pair(&p, &q), std::pair(&q, &p)}) {
        const Kernel::Triangle_3 triangle((*corners)[0], (*corners)[1], (*corners)[2]);
        if (triangle.is_degenerate()) continue; // it is its edges
        for (std::size_t k = 0; k < 3; ++k) {
            if (CGAL::do_intersect(edge(*others, k), triangle)) return 0;
            offer(CGAL::squared_distance((*others)[k], triangle));
        }
    }
    return std::sqrt(CGAL::to_double(least));
}

TrianglePoints random_triangle(Random& random, const ExactMap& map, float size) {
    const float radius = map.view().radius;
    const Vec3f middle = map.view().centre + in_sphere(random, 1.2F * radius);
    return {middle + in_cube(random, size * radius), middle + in_cube(random, size * radius),
            middle + in_cube(random, size * radius)};
}

/// A triangle parallel to a face, where nearest points are not unique.
TrianglePoints beside(const TriangleMesh& mesh, std::size_t face, float height) {
    const auto [a, b, c] = mesh.faces[face];
    const Vec3f p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    const Vec3f normal = cross(q - p, r - p);
    const Vec3f offset = normal * (height / length(normal));
    return {p + offset, q + offset, r + offset};
}

} // namespace

TEST(SurfaceQueriesOracle, TrianglesIntersectTheSnappedFacesAsCgalSays) {
    Random random(1);
    for (const auto& [name, mesh] : generated_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        const LatticeFrame frame(view.centre, view.radius);
        TriangleMesh lattice;
        for (const auto& v : view.vertices) lattice.vertices.push_back(Vec3f(v));
        for (std::size_t f = 0; f < view.face_count(); ++f)
            lattice.faces.push_back({view.corners[3 * f], view.corners[3 * f + 1], view.corners[3 * f + 2]});
        for (int i = 0; i < 150; ++i) {
            const TrianglePoints triangle =
                i % 3 == 0 ? beside(mesh, static_cast<std::size_t>(i) % mesh.faces.size(), 0)
                           : random_triangle(random, map, 0.3F);
            TriangleMesh snapped{{}, {{0, 1, 2}}};
            for (const Vec3f& p : triangle) snapped.vertices.push_back(Vec3f(rounded(frame.to_lattice(p))));
            ASSERT_EQ(intersects(view, triangle), !intersecting_pairs_by_cgal(snapped, lattice).empty())
                << name << ", " << i;
        }
    }
}

TEST(SurfaceQueriesOracle, DistancesAreCgalsFromBelow) {
    Random random(2);
    FaceLists lists;
    for (const auto& [name, mesh] : generated_meshes()) {
        const ExactMap map = ExactMap::build(mesh);
        const ExactMapView& view = map.view();
        const LatticeFrame frame(view.centre, view.radius);
        const double tolerance = 1e-6 * view.radius;
        for (int i = 0; i < 12; ++i) {
            TrianglePoints triangle =
                i % 3 == 0 ? beside(mesh, static_cast<std::size_t>(17 * i) % mesh.faces.size(), 0.01F)
                           : random_triangle(random, map, i % 3 == 1 ? 0.3F : 0.01F);
            if (i % 4 == 3) triangle[2] = triangle[1] + (triangle[1] - triangle[0]) * 1e-6F; // a sliver
            const double reach = 0.2 * view.radius;
            faces_within_batch(view, triangle, std::vector<Triangle>{{0, 1, 2}}, static_cast<float>(reach),
                               lists);
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t f = 0; f < view.face_count(); ++f) {
                QueryCorners face;
                for (std::size_t k = 0; k < 3; ++k)
                    face[k] = frame.to_local(Vec3d(view.vertices[view.corners[3 * f + k]]));
                const double distance = distance_by_cgal(in_double(triangle), face);
                least = std::min(least, distance);
                if (std::fabs(distance - reach) < tolerance) continue;
                ASSERT_EQ(std::binary_search(lists[0].begin(), lists[0].end(), view.face_numbers[f]),
                          distance < reach)
                    << name << ", " << i << ": face " << f << " at " << distance << " of " << reach;
            }
            const float found = clearance(view, triangle).distance;
            ASSERT_LE(found, least * (1 + 1e-12)) << name << ", " << i;
            ASSERT_GE(found, least - tolerance) << name << ", " << i;
        }
    }
}
