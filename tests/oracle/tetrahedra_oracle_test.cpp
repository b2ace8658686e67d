#include "judges/exact_judge.hpp"
#include "judges/nasty_meshes.hpp"
#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/tetrahedra.hpp>

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;
using namespace echinus::test;

namespace {

using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;

Exact::Point_3 exact(const Vec3f& p) {
    return {p.x, p.y, p.z};
}

struct Body {
    std::vector<TriangleMesh> parts; ///< of the model; the judge's parity does not know unions
    TetrahedralMesh mesh;
    TriangleMesh surface;
    double radius;
};

Body make_body(const std::vector<TriangleMesh>& parts, double size) {
    TriangleMesh model;
    for (const TriangleMesh& part : parts) model = joined({model, part});
    const ExactMap map = ExactMap::build(model);
    TetrahedralMesh mesh = tetrahedralize(map, {.size = size}).mesh;
    return {parts, mesh, boundary(mesh), double{map.view().radius}};
}

std::vector<Body> bodies() {
    return {
        make_body({make_torus(1, 0.4, 60, 24)}, 0.17), make_body({turned(make_box({1, 2, 0.7}, 2))}, 0.19),
        make_body({make_sphere(1, 40, 20), translated(make_sphere(0.8, 30, 15), {1.1F, 0.2F, 0.1F})}, 0.2)};
}

std::vector<std::uint8_t> vertices_of_faces(const TriangleMesh& surface) {
    std::vector<std::uint8_t> is_used(surface.vertices.size());
    for (const Triangle& face : surface.faces)
        for (const std::uint32_t vertex : face) is_used[vertex] = 1;
    return is_used;
}

} // namespace

TEST(TetrahedraOracle, VolumesAddUpExactlyToWhatTheBoundaryEncloses) {
    for (const Body& body : bodies()) {
        CGAL::Exact_rational sum = 0, enclosed = 0;
        for (const auto& [a, b, c, d] : body.mesh.tetrahedra) {
            const auto& v = body.mesh.vertices;
            const CGAL::Exact_rational volume =
                CGAL::volume(exact(v[a]), exact(v[b]), exact(v[c]), exact(v[d]));
            ASSERT_GT(volume, 0);
            sum += volume;
        }
        for (const auto& [a, b, c] : body.surface.faces) {
            const auto& v = body.surface.vertices;
            enclosed += CGAL::volume(Exact::Point_3(0, 0, 0), exact(v[a]), exact(v[b]), exact(v[c]));
        }
        EXPECT_EQ(sum, enclosed);
        EXPECT_TRUE(self_intersecting_pairs_by_cgal(body.surface).empty());
    }
}

TEST(TetrahedraOracle, TheBoundaryLiesOnTheModelAndTheRestInside) {
    for (const Body& body : bodies()) {
        std::vector<ExactJudge> judges;
        for (const TriangleMesh& part : body.parts) judges.emplace_back(part);
        const std::vector<std::uint8_t> is_outer = vertices_of_faces(body.surface);
        std::size_t inner_count = 0;
        for (std::size_t vertex = 0; vertex < is_outer.size(); ++vertex) {
            const Vec3f& p = body.mesh.vertices[vertex];
            bool is_on_model = false, is_inside = false;
            for (const ExactJudge& judge : judges) {
                is_on_model = is_on_model || judge.distance(Vec3d(p)) <= 4e-6 * body.radius;
                is_inside = is_inside || judge.inside(p);
            }
            // Where the body closes around a groove too narrow for the lattice, its bottom becomes an inner
            // vertex.
            ASSERT_TRUE(is_on_model || (is_outer[vertex] == 0 && is_inside));
            inner_count += !is_on_model;
        }
        EXPECT_GT(inner_count, 0U);
    }
}

TEST(TetrahedraOracle, PointsAreInATetrahedronWhereTheyAreInsideTheBoundary) {
    for (const Body& body : bodies()) {
        const ExactJudge judge(body.surface);
        Random random(7);
        std::vector<Vec3f> points;
        for (int i = 0; i < 3000; ++i) points.push_back(in_cube(random, static_cast<float>(body.radius)));
        const Embedding embedding = embed(body.mesh, points);
        std::size_t inside_count = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (judge.distance(Vec3d(points[i])) < 1e-5) continue;
            const bool is_in =
                *std::min_element(embedding[i].weights.begin(), embedding[i].weights.end()) > -1e-5F;
            ASSERT_EQ(is_in, judge.inside(points[i]));
            inside_count += is_in;
        }
        EXPECT_GT(inside_count, 100U);
    }
}
