#include "mesh_io/readers.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

using namespace echinus;
using namespace echinus::test;

namespace {

const MeshSource kSource{"polygons", ""};

PolygonMesh one_polygon(const std::vector<Vec3f>& vertices) {
    PolygonMesh mesh{std::vector<Vec3d>(vertices.begin(), vertices.end()), {}, {}};
    mesh.corners.resize(mesh.vertices.size());
    std::iota(mesh.corners.begin(), mesh.corners.end(), 0U);
    mesh.corner_counts = {static_cast<std::uint32_t>(mesh.corners.size())};
    return mesh;
}

Vec3d area_vector(const TriangleMesh& mesh, const Triangle& face) {
    const Vec3d a(mesh.vertices[face[0]]);
    return cross(Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a) * 0.5;
}

double shoelace_area(const std::vector<Vec3f>& flat) {
    double sum = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const Vec3f& a = flat[i];
        const Vec3f& b = flat[(i + 1) % flat.size()];
        sum += double(a.x) * b.y - double(b.x) * a.y;
    }
    return sum / 2;
}

/// In the plane z = 0, counter-clockwise: the triangles must cover the polygon exactly once, so all have the
/// same orientation and their areas add up to the polygon's.
void expect_covered(const std::vector<Vec3f>& flat) {
    const TriangleMesh mesh = triangulate(one_polygon(flat), kSource);
    ASSERT_EQ(mesh.faces.size(), flat.size() - 2);
    double sum = 0;
    for (const Triangle& face : mesh.faces) {
        const double area = area_vector(mesh, face).z;
        EXPECT_GE(area, 0);
        sum += area;
    }
    EXPECT_NEAR(sum, shoelace_area(flat), 1e-12 * std::abs(sum));
}

/// Corners at random distances around the origin: simple, and concave in many places.
std::vector<Vec3f> random_star(std::mt19937& random, std::size_t corner_count) {
    std::uniform_real_distribution<double> radius(0.2, 2);
    std::vector<Vec3f> corners;
    for (std::size_t i = 0; i < corner_count; ++i) {
        const double angle_rad = 2 * std::numbers::pi * double(i) / double(corner_count);
        const double r = radius(random);
        corners.emplace_back(Vec3d{r * std::cos(angle_rad), r * std::sin(angle_rad), 0});
    }
    return corners;
}

} // namespace

TEST(Triangulate, CutsAConvexPolygonIntoAFanAroundItsFirstCorner) {
    const TriangleMesh mesh =
        triangulate(one_polygon({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}}), kSource);
    EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Triangulate, CutsADartAlongTheDiagonalThatLiesInside) {
    // Corner 1 is the reflex one: the diagonal goes from it to corner 3, not from 0 to 2.
    const std::vector<Vec3f> dart{{-2, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, 4, 0}};
    expect_covered(dart);
    const TriangleMesh mesh = triangulate(one_polygon(dart), kSource);
    for (const Triangle& face : mesh.faces) {
        EXPECT_EQ(std::count(face.begin(), face.end(), 1U), 1);
        EXPECT_EQ(std::count(face.begin(), face.end(), 3U), 1);
    }
}

TEST(Triangulate, CoversConcavePolygonsExactlyOnce) {
    std::mt19937 random(1);
    for (int round = 0; round < 300; ++round) expect_covered(random_star(random, 4 + random() % 30));
    expect_covered(random_star(random, 1000));
}

TEST(Triangulate, CoversACombAndASpiral) {
    std::vector<Vec3f> comb;
    for (int tooth = 0; tooth < 40; ++tooth) {
        comb.emplace_back(float(tooth), 0.0F, 0.0F);
        comb.emplace_back(float(tooth) + 0.5F, 9.0F, 0.0F);
    }
    comb.emplace_back(40.0F, 0.0F, 0.0F);
    comb.emplace_back(40.0F, 10.0F, 0.0F);
    comb.emplace_back(0.0F, 10.0F, 0.0F);
    expect_covered(comb);

    std::vector<Vec3f> spiral;
    for (double turn = 0; turn < 6; turn += 0.05)
        spiral.emplace_back(Vec3d{(turn + 2) * std::cos(turn * 3), (turn + 2) * std::sin(turn * 3), 0});
    for (double turn = 5.95; turn >= 0; turn -= 0.05)
        spiral.emplace_back(Vec3d{(turn + 1.5) * std::cos(turn * 3), (turn + 1.5) * std::sin(turn * 3), 0});
    if (shoelace_area(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
    expect_covered(spiral);
}

TEST(Triangulate, CoversPolygonsWithCornersOnStraightSidesAndWithASlitToAHole) {
    expect_covered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}});
    expect_covered({{0, 0, 0},
                    {4, 0, 0},
                    {4, 4, 0},
                    {0, 4, 0},
                    {0, 0, 0},
                    {1, 1, 0},
                    {1, 3, 0},
                    {3, 3, 0},
                    {3, 1, 0},
                    {1, 1, 0}});
}

TEST(Triangulate, KeepsTheOrientationInSpaceWhateverTheNormal) {
    std::mt19937 random(2);
    for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}, Vec3d{1, 2, 3}})
        for (int quarter = 0; quarter < 4; ++quarter) {
            const Rotation rotation = Rotation::about(axis, quarter * std::numbers::pi / 2 + 0.1);
            const Vec3d normal = rotation.apply({0, 0, 1});
            std::vector<Vec3f> corners = random_star(random, 12);
            const double area = shoelace_area(corners);
            for (Vec3f& corner : corners) corner = Vec3f(rotation.apply(Vec3d(corner)) + Vec3d{5, -3, 8});
            const TriangleMesh mesh = triangulate(one_polygon(corners), kSource);
            double sum = 0;
            for (const Triangle& face : mesh.faces) {
                const double part = dot(area_vector(mesh, face), normal);
                EXPECT_GT(part, -1e-5);
                sum += part;
            }
            EXPECT_NEAR(sum, area, 1e-5);
        }
}

TEST(Triangulate, GivesEveryPolygonItsNumberOfTrianglesEvenIfItHasNoArea) {
    const std::vector<Vec3f> bow_tie{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 3, 0}};
    EXPECT_EQ(triangulate(one_polygon(bow_tie), kSource).faces.size(), 3U);
    EXPECT_EQ(triangulate(one_polygon(std::vector<Vec3f>(7, Vec3f{1, 2, 3})), kSource).faces.size(), 5U);
    EXPECT_EQ(triangulate(one_polygon({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}), kSource).faces.size(),
              2U);
}

TEST(Triangulate, LeavesOutPointsAndLinesAndKeepsTheOrderOfPolygons) {
    const PolygonMesh polygons{
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3, 0, 1, 2, 3, 2, 3, 0}, {1, 2, 0, 4, 4}};
    const TriangleMesh mesh = triangulate(polygons, kSource);
    EXPECT_EQ(mesh.faces.size(), 4U);
    EXPECT_EQ(mesh.faces[0], (Triangle{3, 0, 1}));
    EXPECT_EQ(mesh.faces[2], (Triangle{3, 2, 3}));
}

TEST(Triangulate, RefusesEnormousConcavePolygonsAndTakesConvexOnes) {
    std::mt19937 random(3);
    const PolygonMesh concave = one_polygon(random_star(random, kMaxConcaveCorners + 1));
    expect_error(ErrorCode::InvalidMesh, "polygon 0 is concave", [&] { triangulate(concave, kSource); });

    // A convex one: the tangents of a parabola keep their turns above the rounding of float.
    std::vector<Vec3f> parabola;
    for (int i = -2500; i <= 2500; ++i) parabola.emplace_back(float(i), float(i) * float(i), 0.0F);
    EXPECT_EQ(triangulate(one_polygon(parabola), kSource).faces.size(), parabola.size() - 2);
}
