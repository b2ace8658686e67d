// Public reports about sides, distances, crossings and repair, most of them of other programs: the shape,
// made anew from the description, and the right answer.

#include "support/meshes.hpp"
#include "support/random_points.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

using namespace echinus;
using namespace echinus::test;

namespace {

/// From (0, 0, 0) to (1, 1, 1), whose corners' numbers have the coordinates as bits.
TriangleMesh unit_cube() {
    TriangleMesh cube;
    for (std::uint32_t i = 0; i < 8; ++i)
        cube.vertices.push_back(Vec3f(Vec3<std::uint32_t>{i & 1, i >> 1 & 1, i >> 2}));
    cube.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {1, 3, 7}, {1, 7, 5}, {3, 2, 6}, {3, 6, 7}, {2, 0, 4}, {2, 4, 6}};
    return cube;
}

TriangleMesh box(const Vec3d& low, const Vec3d& high) {
    return translated(make_box(high - low), Vec3f((low + high) * 0.5));
}

/// Each face has corners of its own, as in an STL file.
TriangleMesh unwelded(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const Triangle& face : mesh.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t corner : face) soup.vertices.push_back(mesh.vertices[corner]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}

/// Walls and a floor of a height field over a grid, closed below.
TriangleMesh terrain(std::uint32_t side, const std::function<float(std::uint32_t, std::uint32_t)>& height) {
    TriangleMesh mesh;
    const auto number = [&](std::uint32_t x, std::uint32_t y, std::uint32_t layer) {
        return (layer * (side + 1) + y) * (side + 1) + x;
    };
    for (std::uint32_t layer = 0; layer < 2; ++layer)
        for (std::uint32_t y = 0; y <= side; ++y)
            for (std::uint32_t x = 0; x <= side; ++x)
                mesh.vertices.push_back({float(x), float(y), layer == 0 ? -1 : height(x, y)});
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    };
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            add(number(x, y, 1), number(x + 1, y, 1), number(x + 1, y + 1, 1), number(x, y + 1, 1));
            add(number(x, y, 0), number(x, y + 1, 0), number(x + 1, y + 1, 0), number(x + 1, y, 0));
        }
    for (std::uint32_t i = 0; i < side; ++i) {
        add(number(i, 0, 0), number(i + 1, 0, 0), number(i + 1, 0, 1), number(i, 0, 1));
        add(number(i + 1, side, 0), number(i, side, 0), number(i, side, 1), number(i + 1, side, 1));
        add(number(0, i + 1, 0), number(0, i, 0), number(0, i, 1), number(0, i + 1, 1));
        add(number(side, i, 0), number(side, i + 1, 0), number(side, i + 1, 1), number(side, i, 1));
    }
    return mesh;
}

/// A house with a gable roof along y: five corners, extruded.
TriangleMesh house() {
    const std::array<Vec3f, 5> front{Vec3f{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 2}, {0, 0, 1}};
    TriangleMesh mesh;
    for (const float y : {0.0F, 3.0F})
        for (const Vec3f& p : front) mesh.vertices.push_back({p.x, y, p.z});
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {5, 7, 6}, {5, 8, 7}, {5, 9, 8}};
    for (std::uint32_t i = 0; i < 5; ++i) {
        const std::uint32_t j = (i + 1) % 5;
        mesh.faces.push_back({j, i, i + 5});
        mesh.faces.push_back({j, i + 5, j + 5});
    }
    return mesh;
}

TriangleMesh icosahedron() {
    const auto g = static_cast<float>((1 + std::sqrt(5.0)) / 2);
    return {{{-1, g, 0},
             {1, g, 0},
             {-1, -g, 0},
             {1, -g, 0},
             {0, -1, g},
             {0, 1, g},
             {0, -1, -g},
             {0, 1, -g},
             {g, 0, -1},
             {g, 0, 1},
             {-g, 0, -1},
             {-g, 0, 1}},
            {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

/// A cube from which a cube at the origin's corner is cut out.
TriangleMesh notched_cube() {
    TriangleMesh mesh =
        joined({box({0, 0, 0.5}, {1, 1, 1}), box({0.5, 0, 0}, {1, 1, 0.5}), box({0, 0.5, 0}, {0.5, 1, 0.5})});
    return mesh; // three boxes that touch: the same solid
}

struct SideReport {
    const char* thread;
    TriangleMesh mesh;
    std::vector<Vec3f> inside, outside;
    bool repair = false;
};

std::vector<SideReport> side_reports() {
    TriangleMesh opposite_doubles = unit_cube(); // eight faces again, turned over
    for (std::size_t f = 0; f < 8; ++f) {
        const auto [a, b, c] = opposite_doubles.faces[f];
        opposite_doubles.faces.push_back({a, c, b});
    }
    return {
        {"NVIDIA/warp#1836: sign by the normal of the nearest face beside a sharp tetrahedron",
         {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}}},
         {{0.1F, 0.1F, 0.1F}, {0.3F, 0.3F, 0.3F}},
         {{2, -1, -1},
          {-1, -1, 2},
          {1.5F, -0.1F, -0.1F},
          {-0.1F, 1.5F, -0.1F},
          {0.4F, 0.4F, 0.4F},
          // Warp 1.19.0 finds these inside.
          {1.439F, 0.488F, 0.462F},
          {2.655F, 1.676F, 1.746F},
          {0.226F, 0.211F, 1.201F}}},
        {"isl-org/Open3D#5105: a ray along the diagonal touches the cube in an edge",
         unit_cube(),
         {{0.5F, 0.5F, 0.5F}},
         {{-1, -1, 0}, {-1, -1, -1}, {-1, 0, -1}, {2, 2, 1}}},
        {"isl-org/Open3D#5669, mikedh/trimesh#545: signs around a sphere",
         make_sphere(0.8, 40, 20),
         {{0, 0, 0}, {0.79F, 0, 0}, {0, 0, 0.79F}, {0, 0, -0.79F}},
         {{0.81F, 0, 0}, {0, 0, 0.81F}, {0, 0, -0.81F}, {0.6F, 0.6F, 0.6F}}},
        {"dimforge/parry#171, dimforge/ncollide#335, clbarnes/ncollpyde#3: rays that skim a ridge",
         house(),
         {{1, 1, 1.9F}, {1, 1.5F, 1}, {1, 2.9F, 2 - 1e-4F}},
         {{-1, 1, 2}, {3, 1, 2}, {1, -1, 2}, {1, 5, 2}, {1, 1, 2.1F}, {-5, 1, 1}, {0.4F, 1, 1.5F}}},
        {"mikedh/trimesh#85, #2317, #242, CGAL/cgal#1945: rays through edges and corners of a cube",
         make_box({2, 2, 2}, 4),
         {{0, 0, 0}, {0.5F, 0.5F, 0.5F}, {0.5F, 0, 0}, {-0.5F, 0.5F, 0}},
         {{0, 0, 3}, {3, 3, 3}, {0.5F, 0.5F, -3}, {-3, 0, 0.5F}, {1.5F, 1.5F, 0}, {2, 0, 0}}},
        {"mikedh/trimesh#269: a notch in a cube",
         notched_cube(),
         {{0.9F, 0.9F, 0.9F}, {0.1F, 0.1F, 0.9F}, {0.6F, 0.1F, 0.1F}},
         {{0.1F, 0.1F, 0.1F}, {0.4F, 0.4F, 0.4F}}},
        {"ProjectPhysX/FluidX3D#323: vertical slices through a grid of heights",
         terrain(8, [](std::uint32_t x, std::uint32_t y) { return float(x * y % 3); }),
         {{1, 1, 0.9F}, {2, 4, 1.9F}, {4, 4, -0.5F}, {3, 5, -0.9F}, {3, 5, -0.001F}},
         {{1, 1, 1.1F}, {2, 4, 2.1F}, {3, 5, 0.001F}, {4, 4, 5}, {9, 4, 0}, {4, 4, -1.1F}}},
        {"libigl/libigl-python-bindings#137: winding numbers beside the faces of an icosahedron",
         icosahedron(),
         {{0, 0, 0}, {0.85F, 0.85F, 0.85F}, {-0.85F, 0.85F, 0.85F}},
         {{0.9F, 0.9F, 0.9F}, {-0.9F, 0.9F, -0.9F}}},
        {"NVlabs/instant-ngp#775: the sides of a box itself",
         make_box({2, 1, 1}),
         {{0.9999F, 0, 0}, {0, 0.4999F, 0}, {0, 0, -0.4999F}},
         {{1.0001F, 0, 0}, {0, 0.5001F, 0}, {0, 0, -0.5001F}}},
        {"gcherchi/InteractiveAndRobustMeshBooleans#12: well oriented, though it was refused",
         {{{1, 0, 1}, {0, 0, 0}, {1.3F, 0.5F, 1.1F}, {1, 1, 2}, {1.4F, 0.5F, 2}, {1, 0, 2}},
          {{0, 1, 2}, {1, 3, 2}, {3, 1, 4}, {1, 5, 4}, {4, 5, 2}, {5, 0, 2}, {5, 1, 0}, {3, 4, 2}}},
         {{1, 0.3F, 1.5F}},
         {{0, 1, 1}, {1.4F, 0.1F, 1}}},
        {"SCIInstitute/ShapeWorks#2033: sign by the normal of the nearest face above a sharp ridge",
         {{{-1, -0.02F, 0}, {1, -0.02F, 0}, {1, 0.02F, 0}, {-1, 0.02F, 0}, {-1, 0, 1}, {1, 0, 1}},
          {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {2, 3, 4}, {2, 4, 5}, {3, 0, 4}, {1, 2, 5}}},
         {{0, 0, 0.99F}, {0.99F, 0, 0.5F}},
         {{0, 0, 1.01F}, {1.01F, 0, 1.01F}, {0, 0.02F, 0.9F}, {0, -0.02F, 1.2F}}},
        {"mikedh/trimesh#1416: boxes that overlap",
         joined({unit_cube(), translated(unit_cube(), {0.5F, 0.25F, 0})}),
         {{0.75F, 0.5F, 0.5F}, {0.1F, 0.5F, 0.5F}, {1.4F, 1.2F, 0.5F}},
         {{0.25F, 1.2F, 0.5F}, {1.2F, 0.1F, 0.5F}}},
        {"mikedh/trimesh#2534: a cavity",
         joined({make_box({2, 2, 2}), turned_inside_out(make_box({1, 1, 1}))}),
         {{0.75F, 0, 0}, {0, -0.75F, 0.2F}},
         {{0, 0, 0}, {0.4F, 0.4F, -0.4F}, {1.1F, 0, 0}}},
        {"mikedh/trimesh#145: blocks that share an edge",
         joined({unit_cube(), translated(unit_cube(), {1, 1, 0})}),
         {{0.9F, 0.9F, 0.5F}, {1.1F, 1.1F, 0.5F}},
         {{0.9F, 1.1F, 0.5F}, {1.1F, 0.9F, 0.5F}}},
        {"mikedh/trimesh#181: a sphere of the size of a bacterium",
         translated(make_sphere(1e-5, 24, 12), {0.5F, 0.5F, 0.5F}),
         {{0.5F, 0.5F, 0.5F}},
         {{0.50002F, 0.5F, 0.5F}, {0, 0, 0}}},
        {"AcademySoftwareFoundation/openvdb#903: between two spheres",
         joined({translated(make_sphere(1, 32, 16), {-1.05F, 0, 0}),
                 translated(make_sphere(1, 32, 16), {1.05F, 0, 0})}),
         {{-0.1F, 0, 0}, {0.1F, 0, 0}},
         {{0, 0, 0}, {0, 0.5F, 0}}},
        {"NVIDIAGameWorks/kaolin#566: points on the axes",
         make_sphere(2, 24, 12),
         {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
         {{3, 0, 0}, {0, 3, 0}, {0, 0, 3}}},
        {"CloudCompare/CloudCompare#1976: in the planes of a box's sides",
         make_box({2, 2, 2}),
         {{0, 0, 0}},
         {{2, 1, 1}, {2, 1, 0}, {1, 2, -1}, {-1, -1, 2}, {2, 2, 1}}},
        {"libigl/libigl#644: eight faces of a cube again, turned over",
         opposite_doubles,
         {{0.5F, 0.5F, 0.5F}},
         {{0.5F, 0.5F, 1.5F}, {-0.5F, 0.5F, 0.5F}},
         true},
        {"CGAL/cgal#2513, mikedh/trimesh#165: one of two parts is inside out",
         joined({unit_cube(), turned_inside_out(translated(unit_cube(), {3, 0, 0}))}),
         {{0.5F, 0.5F, 0.5F}, {3.5F, 0.5F, 0.5F}},
         {{2, 0.5F, 0.5F}},
         true},
        {"GavinBarill/fast-winding-number-soups#2, nmwsharp/geometry-central#142: every second face turned",
         [] {
             TriangleMesh cube = unit_cube();
             for (std::size_t f = 0; f < cube.faces.size(); f += 2)
                 std::swap(cube.faces[f][1], cube.faces[f][2]);
             return cube;
         }(),
         {{0.5F, 0.5F, 0.5F}, {0.1F, 0.9F, 0.2F}},
         {{1.5F, 0.5F, 0.5F}, {-0.1F, 0.1F, 0.1F}},
         true},
        {"fwilliams/point-cloud-utils#94, #73: faces whose corners became one",
         [] {
             TriangleMesh cube = unit_cube();
             cube.faces.push_back({3, 3, 5});
             cube.faces.push_back({6, 6, 6});
             return cube;
         }(),
         {{0.5F, 0.5F, 0.5F}},
         {{1.5F, 0.5F, 0.5F}}},
        {"wolph/numpy-stl#186, danielepanozzo/cg-old#65: corners that differ in the sign of their zeros",
         [] {
             TriangleMesh soup = unwelded(unit_cube());
             for (std::size_t i = 0; i < soup.vertices.size(); i += 2)
                 if (soup.vertices[i].x == 0) soup.vertices[i].x = -0.0F;
             return weld(soup);
         }(),
         {{0.5F, 0.5F, 0.5F}, {1e-4F, 0.5F, 0.5F}},
         {{-1e-4F, 0.5F, 0.5F}}},
    };
}

/// The right answers of brute force, which knows nothing of maps, at points that are not on the surface.
void expect_sides_by_brute_force(const TriangleMesh& mesh, const ExactMap& map) {
    constexpr int kPointCount = 200;
    const Sphere sphere = inspect(mesh).bounding_sphere;
    Random random(7);
    std::uniform_real_distribution<double> coordinate(-1.1, 1.1);
    for (int i = 0; i < kPointCount; ++i) {
        const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
        const Vec3f point(Vec3d(sphere.centre) + Vec3d{x, y, z} * double{sphere.radius});
        if (unsigned_distance(mesh, Vec3d(point)) < 4e-6 * double{sphere.radius}) continue;
        ASSERT_EQ(contains(map.view(), point), std::fabs(winding_number(mesh, Vec3d(point))) > 0.5)
            << point.x << " " << point.y << " " << point.z;
    }
}

} // namespace

TEST(Reports, OfSidesAreAnswered) {
    for (const SideReport& report : side_reports()) {
        SCOPED_TRACE(report.thread);
        const TriangleMesh mesh =
            report.repair ? repair(report.mesh, RepairOptions::all()).mesh : report.mesh;
        ASSERT_TRUE(inspect(mesh).closed);
        const ExactMap map = ExactMap::build(mesh);
        for (const Vec3f& p : report.inside)
            EXPECT_TRUE(contains(map.view(), p)) << p.x << " " << p.y << " " << p.z;
        for (const Vec3f& p : report.outside)
            EXPECT_FALSE(contains(map.view(), p)) << p.x << " " << p.y << " " << p.z;
        expect_sides_by_brute_force(mesh, map);
    }
}

TEST(Reports, OfDistancesAreAnswered) {
    struct DistanceReport {
        const char* thread;
        TriangleMesh mesh;
        Vec3f point;
        double distance;
    };
    const std::vector<DistanceReport> reports{
        {"isl-org/Open3D#5105: beside an edge", unit_cube(), {-1, -1, 0}, std::sqrt(2.0)},
        {"isl-org/Open3D#5105: beside a corner", unit_cube(), {-1, -1, -1}, std::sqrt(3.0)},
        {"isl-org/Open3D#5105: the middle", unit_cube(), {0.5F, 0.5F, 0.5F}, -0.5},
        {"gkjohnson/three-mesh-bvh#305: far away",
         make_sphere(1, 64, 32),
         {10, 12, 15},
         std::sqrt(469.0) - 1},
        {"AcademySoftwareFoundation/openvdb#903: between two spheres",
         joined({translated(make_sphere(1, 32, 16), {-1.05F, 0, 0}),
                 translated(make_sphere(1, 32, 16), {1.05F, 0, 0})}),
         {0, 0, 0},
         0.05},
        {"AcademySoftwareFoundation/openvdb#903: between two boxes",
         joined({box({-2, -1, -1}, {-0.05, 1, 1}), box({0.05, -1, -1}, {2, 1, 1})}),
         {0, 0, 0},
         0.05},
        {"dimforge/parry#171: beside a roof", house(), {-1, 1, 2}, std::sqrt(2.0)},
        {"mikedh/trimesh#2534: in a cavity",
         joined({make_box({2, 2, 2}), turned_inside_out(make_box({1, 1, 1}))}),
         {0, 0, 0},
         0.5},
        {"BerkeleyAutomation/python-fcl#54: on a face",
         {{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}},
         {1, 1, 1},
         0},
        {"libigl/libigl#1204: within a plane of the surface", unit_cube(), {0.25F, 0.5F, 1}, 0},
        {"dimforge/parry#75: beside a triangle, beyond its edge",
         joined({{{{21.94F, 3.7F, 0}, {22.255F, 3.7F, -0.315F}, {22.255F, 3.5F, -0.315F}},
                  {{0, 1, 2}, {0, 2, 1}}},
                 box({24, 3, -1}, {25, 4, 0})}),
         {22.01F, 3.7F, -0.291F},
         0.15627},
    };
    for (const DistanceReport& report : reports) {
        SCOPED_TRACE(report.thread);
        const ExactMap map = ExactMap::build(report.mesh);
        const Sphere sphere = inspect(report.mesh).bounding_sphere;
        Vec3f gradient;
        const float distance = signed_distance(map.view(), report.point, &gradient);
        EXPECT_NEAR(double{distance}, report.distance,
                    4e-6 * double{sphere.radius} + 2e-3 * (report.distance > 10));
        EXPECT_NEAR(std::fabs(double{distance}), unsigned_distance(report.mesh, Vec3d(report.point)),
                    4e-6 * double{sphere.radius});
        EXPECT_TRUE(is_finite(gradient));
    }
}

TEST(Reports, OfFacesThatMeetThemselvesAreAnswered) {
    struct IntersectionReport {
        const char* thread;
        TriangleMesh mesh;
        std::size_t pair_count;
    };
    const std::vector<IntersectionReport> reports{
        {"libigl/libigl#2381: a triangle that is divided twice, rounded",
         {{{0.280039F, 0.827663F, 0.463775F},
           {0.338901F, 0.788042F, 0.488127F},
           {0.318053F, 0.768364F, 0.493088F},
           {0.30947F, 0.8078525F, 0.475951F},
           {0.299046F, 0.7980135F, 0.4784315F},
           {0.328477F, 0.778203F, 0.4906075F},
           {0.2947545F, 0.8177578F, 0.469863F},
           {0.2895425F, 0.8128383F, 0.4711033F},
           {0.3241855F, 0.7979473F, 0.482039F},
           {0.333689F, 0.7831225F, 0.4893672F},
           {0.3085495F, 0.7831888F, 0.4857598F},
           {0.323265F, 0.7732835F, 0.4918478F},
           {0.304258F, 0.802933F, 0.4771913F},
           {0.3189735F, 0.7930278F, 0.4832793F},
           {0.3137615F, 0.7881083F, 0.4845195F}},
          {{2, 11, 10},
           {1, 8, 9},
           {0, 7, 6},
           {3, 12, 13},
           {5, 14, 11},
           {3, 13, 8},
           {4, 12, 7},
           {4, 14, 12},
           {4, 10, 14},
           {5, 9, 13},
           {3, 6, 12},
           {5, 13, 14},
           {14, 10, 11},
           {13, 9, 8},
           {12, 6, 7},
           {14, 13, 12}}},
         0},
        {"cnr-isti-vclab/meshlab#50: faces around a vertex, and two of a square beside them",
         make_sphere(1, 24, 12), 0},
        {"isl-org/Open3D#5117: faces that share a vertex and cross",
         {{{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {2, 0, -1}, {2, 0, 1}}, {{0, 1, 2}, {0, 3, 4}}},
         1},
        {"isl-org/Open3D#1171, #1185: a solid whose faces touch at their edges only", unit_cube(), 0},
        {"MeshInspector/MeshLib#5578: faces in a plane that share an edge and lie on each other",
         {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25F, 0.25F, 0}}, {{0, 1, 2}, {0, 1, 3}}},
         1},
    };
    for (const IntersectionReport& report : reports)
        EXPECT_EQ(self_intersecting_pairs(report.mesh).size(), report.pair_count) << report.thread;
}

TEST(Reports, OfAThinGapAreAnswered) {
    SCOPED_TRACE("newton-physics/newton#3004: 8192 points between two boxes, 0.2 mm apart");
    const TriangleMesh boxes = joined({box({-1, -1, -1}, {1, 1, -1e-4}), box({-1, -1, 1e-4}, {1, 1, 1})});
    const ExactMap map = ExactMap::build(boxes);
    Random random(1);
    std::uniform_real_distribution<float> across(-1, 1), along(-0.95e-4F, 0.95e-4F);
    int outside_count = 0;
    for (int i = 0; i < 8192; ++i) {
        const Vec3f point{across(random), across(random), along(random)};
        outside_count += !contains(map.view(), point);
    }
    EXPECT_EQ(outside_count, 8192);
    EXPECT_TRUE(contains(map.view(), {0, 0, 1.05e-4F}));
    EXPECT_TRUE(contains(map.view(), {0, 0, -1.05e-4F}));
}

TEST(Reports, OfShotsAtAFlatMeshAreAnswered) {
    SCOPED_TRACE("bepu/bepuphysics2#371: shots that are too fast go through a flat mesh");
    const TriangleMesh plate{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const ExactMap map = ExactMap::build(plate);
    for (float reach = 1; reach <= 1e6F; reach *= 10)
        for (const float side : {1.0F, -1.0F}) {
            const SweepHit hit = sweep(map.view(), {0.25F, 0.5F, side}, {0.25F, 0.5F, -side * reach});
            ASSERT_TRUE(hit.found()) << reach;
            EXPECT_NEAR(double{hit.point.z}, 0, 4e-6);
            EXPECT_NEAR(double{hit.point.x}, 0.25, 4e-6);
        }
}
