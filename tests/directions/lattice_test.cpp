#include "directions/cast_rays.hpp"
#include "directions/face_cone.hpp"
#include "directions/lattice.hpp"
#include "mesh/require_valid.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#ifndef _WIN32
#include <sys/mman.h>
#endif

using namespace echinus;

namespace {

TriangleMesh tetrahedron(const Vec3f& apex) {
    return {{apex, {1, 1, -1}, {-1, 1, -1}, {0, -1, -1}}, {{1, 2, 3}, {2, 1, 0}, {3, 2, 0}, {1, 3, 0}}};
}

/// Neither a face nor the line of an edge passes through the origin.
void expect_clear_of_origin(const LatticeMesh& lattice) {
    for (const Triangle& face : lattice.faces)
        for (int i = 0; i < 3; ++i) {
            const LatticePoint& a = lattice.vertices[face[i]];
            const LatticePoint& b = lattice.vertices[face[(i + 1) % 3]];
            EXPECT_NE(cross(a, b), LatticePoint{});
        }
}

} // namespace

TEST(Lattice, SnapsEveryVertexToWithinHalfAStep) {
    const TriangleMesh mesh = make_torus(3, 1.1, 40, 20);
    const LatticeMesh lattice = snap_to_lattice(mesh);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3d back = Vec3d(lattice.centre) + Vec3d(lattice.vertices[i]) * lattice.frame.step;
        const Vec3d error = back - Vec3d(mesh.vertices[i]);
        for (double e : {error.x, error.y, error.z}) EXPECT_LE(std::abs(e), 0.5000001 * lattice.frame.step);
        EXPECT_LE(length(Vec3d(lattice.vertices[i])), static_cast<double>(kLatticeExtent) + 1);
    }
}

TEST(Lattice, TakesTheSmallestFloatThatEnclosesAllVertices) {
    EXPECT_EQ(snap_to_lattice(make_sphere(524'288, 8, 4)).radius, 524'288.0F);
    for (float size : {1.0F, 3.0F, 0.7F}) {
        const TriangleMesh box = make_box({size, 2.0 * size, 3.0 * size});
        const LatticeMesh lattice = snap_to_lattice(box);
        double farthest = 0;
        for (const Vec3f& vertex : box.vertices)
            farthest = std::max(farthest, length(Vec3d(vertex) - Vec3d(lattice.centre)));
        EXPECT_GE(lattice.radius, farthest);
        EXPECT_LT(std::nextafter(lattice.radius, 0.0F), farthest);
    }
}

TEST(Lattice, MovesTheCentreOffAVertexAnEdgeAndAFace) {
    const TriangleMesh sphere = make_sphere(10, 8, 6); // fixes the bounding sphere's centre at the origin
    const Vec3f on_vertex{0, 0, 0};
    const Vec3f on_edge{-1, -1, 1}; // opposite of (1, 1, -1)
    const Vec3f on_face{0, -1, 1};  // the face with (1, 1, -1) and (-1, 1, -1)
    for (const Vec3f& apex : {on_vertex, on_edge, on_face}) {
        TriangleMesh mesh = tetrahedron(apex);
        const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), sphere.vertices.begin(), sphere.vertices.end());
        for (const Triangle& face : sphere.faces)
            mesh.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
        const LatticeMesh lattice = snap_to_lattice(mesh);
        EXPECT_NE(lattice.centre, Vec3f{});
        EXPECT_LE(length(lattice.centre), 1e-3F);
        expect_clear_of_origin(lattice);
    }
}

TEST(Lattice, DropsFacesThatCollapseAndKeepsTheNumbersOfTheRest) {
    TriangleMesh mesh = make_box({1, 1, 1});
    mesh.vertices.push_back(mesh.vertices[0] + Vec3f{1e-8F, 0, 0});
    mesh.faces.insert(mesh.faces.begin(), {0, 1, static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    const LatticeMesh lattice = snap_to_lattice(mesh);
    EXPECT_EQ(lattice.faces.size(), mesh.faces.size() - 1);
    EXPECT_EQ(lattice.face_numbers.front(), 1U);
}

TEST(Lattice, IgnoresVerticesThatNoFaceUses) {
    TriangleMesh mesh = make_box({1, 1, 1});
    const LatticeMesh alone = snap_to_lattice(mesh);
    mesh.vertices.push_back({std::nanf(""), 1e30F, 0});
    const LatticeMesh with = snap_to_lattice(mesh);
    EXPECT_EQ(with.centre, alone.centre);
    EXPECT_EQ(with.radius, alone.radius);
}

TEST(Lattice, RefusesAMeshOnOnePointAndSizesBeyondFloat) {
    const auto expect_refused = [](const TriangleMesh& mesh) {
        test::expect_error(ErrorCode::InvalidMesh, "", [&] { snap_to_lattice(mesh); });
    };
    TriangleMesh point{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}};
    expect_refused(point);
    expect_refused(make_box({1e20, 1e20, 1e20}));
    expect_refused(make_box({1e-20, 1e-20, 1e-20}));
    EXPECT_NO_THROW(snap_to_lattice(make_box({1e9, 1e9, 1e9})));
    EXPECT_NO_THROW(snap_to_lattice(make_box({1e-9, 1e-9, 1e-9})));
    EXPECT_NO_THROW(snap_to_lattice(make_box({1, 1e-6, 1e-6})));
}

TEST(Lattice, RefusesFacesWhoseVerticesAreNotThere) {
    const std::vector<Triangle> faces{{0, 1, 2}};
    for (std::size_t count = 0; count < 3; ++count) {
        const std::vector<Vec3f> vertices(count);
        LatticeSnapper snapper(faces);
        LatticeMesh result;
        const std::string words = "face 0 of the mesh refers to vertex " + std::to_string(count);
        test::expect_error(ErrorCode::InvalidMesh, words, [&] { snapper.snap(vertices, result); });
        test::expect_error(ErrorCode::InvalidMesh, words, [&] { snapper.snap(vertices, Vec3f{}, result); });
    }
}

using test::joined;
using test::translated;

namespace {

using Faces = std::vector<std::array<LatticePoint, 3>>;

/// |x| + |y| + |z| = r around `middle`, outward. Its edges lie in the coordinate planes, its vertices on the
/// axes.
Faces octahedron(std::int64_t r, const LatticePoint& middle) {
    Faces faces;
    for (std::int64_t sx : {-r, r})
        for (std::int64_t sy : {-r, r})
            for (std::int64_t sz : {-r, r}) {
                const LatticePoint x{middle.x + sx, middle.y, middle.z}, y{middle.x, middle.y + sy, middle.z},
                    z{middle.x, middle.y, middle.z + sz};
                const bool even = ((sx < 0) + (sy < 0) + (sz < 0)) % 2 == 0;
                if (even)
                    faces.push_back({x, y, z});
                else
                    faces.push_back({y, x, z});
            }
    return faces;
}

struct Count {
    int all = 0, outward = 0;
};

Count crossings(const Faces& faces, const LatticePoint& d) {
    Count count;
    for (const auto& [a, b, c] : faces) {
        const FaceCone cone(a, b, c);
        if (cone.edge_on() || !cone.meets(d)) continue;
        ++count.all;
        count.outward += cone.outward();
    }
    return count;
}

} // namespace

TEST(Crossing, RaysThroughVerticesAndEdgesLeaveAConvexSolidOnce) {
    const Faces faces = octahedron(1000, {});
    for (std::int64_t x = -3; x <= 3; ++x)
        for (std::int64_t y = -3; y <= 3; ++y)
            for (std::int64_t z = -3; z <= 3; ++z) {
                if (x == 0 && y == 0 && z == 0) continue;
                const Count count = crossings(faces, {x, y, z});
                EXPECT_EQ(count.all, 1) << x << " " << y << " " << z;
                EXPECT_EQ(count.outward, 1);
            }
}

TEST(Crossing, RaysFromOutsideEnterAsOftenAsTheyLeave) {
    // The origin lies in the plane of four of the edges and is seen along the faces' symmetry planes.
    const Faces faces = octahedron(4, {6, 0, 0});
    for (std::int64_t x = -12; x <= 12; ++x)
        for (std::int64_t y = -12; y <= 12; ++y)
            for (std::int64_t z = -12; z <= 12; ++z) {
                const Count count = crossings(faces, {x, y, z});
                EXPECT_EQ(count.all, 2 * count.outward) << x << " " << y << " " << z;
            }
}

TEST(Crossing, DecidesRightAtTheLimitsOfTheLattice) {
    std::mt19937_64 random(3);
    std::uniform_int_distribution<std::int64_t> coordinate(-kLatticeExtent, kLatticeExtent);
    const Faces faces = octahedron(kLatticeExtent, {});
    for (int n = 0; n < 20'000; ++n) {
        const LatticePoint d{coordinate(random), coordinate(random), coordinate(random)};
        ASSERT_EQ(crossings(faces, d).all, 1);
    }
}

TEST(Crossing, ParameterIsThePlanesDistanceAlongTheRay) {
    const FaceCone cone({0, 0, 10}, {100, 0, 10}, {0, 100, 10});
    ASSERT_TRUE(cone.outward());
    ASSERT_TRUE(cone.meets({3, 3, 4}));
    EXPECT_DOUBLE_EQ(cone.parameter({3, 3, 4}), 2.5);
}

TEST(Crossings, HaveTheParityOfTheCentreOnEveryRayOfAClosedMesh) {
    // Meshes and grids share planes of symmetry, so that many rays meet edges and vertices.
    const struct {
        TriangleMesh mesh;
        std::uint32_t parity;
    } cases[] = {
        {make_box({2, 2, 2}, 4), 1},
        {make_sphere(1, 40, 20), 1},
        {make_torus(1, 0.4, 60, 24), 0},
        {joined({make_box({4, 4, 4}, 2), make_box({1, 1, 1}, 2)}), 0},
        {joined({translated(make_box({1, 1, 1}), {2, 0, 0}), translated(make_box({1, 1, 1}), {-2, 0, 0})}),
         0},
    };
    for (const auto& [mesh, parity] : cases)
        for (PoleAxis axis : {PoleAxis::X, PoleAxis::Y, PoleAxis::Z}) {
            const SphericalGrid grid(80, 40, axis);
            const Crossings crossings = cast_rays(snap_to_lattice(mesh), grid, 1);
            for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d)
                ASSERT_EQ((crossings.offsets[d + 1] - crossings.offsets[d]) % 2, parity) << "direction " << d;
        }
}

TEST(Crossings, StayInTheSphereAndAscend) {
    const LatticeMesh lattice = snap_to_lattice(make_torus(1, 0.4, 60, 24));
    const Crossings crossings = cast_rays(lattice, SphericalGrid(90, 45, PoleAxis::Y), 0);
    for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d) {
        const auto first = crossings.distances.begin() + crossings.offsets[d];
        const auto last = crossings.distances.begin() + crossings.offsets[d + 1];
        EXPECT_TRUE(std::is_sorted(first, last));
    }
    for (float distance : crossings.distances) EXPECT_TRUE(distance >= 0 && distance <= lattice.radius);
}

#ifndef _WIN32

TEST(Lattice, RefusesMoreFacesThanCanBeNumbered) {
    // Address space that nothing may read.
    const std::size_t count = kMostFaces + 1, bytes = count * sizeof(Triangle);
    void* space = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (space == MAP_FAILED) GTEST_SKIP() << "no room for so many addresses";
    LatticeSnapper snapper({static_cast<const Triangle*>(space), count});
    LatticeMesh lattice;
    test::expect_error(ErrorCode::InvalidMesh, "1073741825 faces",
                       [&] { snapper.snap(std::vector<Vec3f>(3), lattice); });
    munmap(space, bytes);
    test::expect_error(ErrorCode::InvalidMesh, "3221225473 vertices",
                       [] { require_numberable(1, 3 * kMostFaces + 1); });
}

#endif
