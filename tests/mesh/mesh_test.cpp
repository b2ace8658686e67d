#include "mesh/local_frame.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/intersections.hpp>
#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace echinus;
using namespace echinus::test;

namespace {

/// Every face gets its own vertices.
TriangleMesh take_apart(const TriangleMesh& mesh) {
    TriangleMesh soup;
    for (const Triangle& face : mesh.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (std::uint32_t vertex : face) soup.vertices.push_back(mesh.vertices[vertex]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}

} // namespace

TEST(Weld, PutsASoupTogetherAgain) {
    const TriangleMesh torus = make_torus(1, 0.4, 12, 8);
    const TriangleMesh welded = weld(take_apart(torus));
    EXPECT_EQ(welded.vertices.size(), torus.vertices.size());
    expect_same_faces(welded, torus);
}

TEST(Weld, LeavesAWeldedMeshAsItIs) {
    const TriangleMesh box = make_box({1, 2, 3}, 3);
    const TriangleMesh welded = weld(box);
    EXPECT_EQ(welded.vertices, box.vertices);
    EXPECT_EQ(welded.faces, box.faces);
}

TEST(Weld, TreatsZeroAndMinusZeroAsEqual) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0F, 0, -0.0F}, {1, 1, 0}},
                            {{0, 1, 2}, {3, 4, 1}}};
    const TriangleMesh welded = weld(mesh);
    EXPECT_EQ(welded.vertices.size(), 4U);
    EXPECT_EQ(welded.faces[1][0], welded.faces[0][0]);
}

TEST(Weld, DropsVerticesThatNoFaceUsesAndKeepsTheOrderOfTheRest) {
    const TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}}, {{4, 1, 3}}};
    const TriangleMesh welded = weld(mesh);
    EXPECT_EQ(welded.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(welded.faces, (std::vector<Triangle>{{2, 0, 1}}));
}

TEST(Weld, RefusesAnIndexOutOfRange) {
    expect_error(ErrorCode::InvalidMesh, "face 0 of the mesh refers to vertex 1", [] {
        weld({{{0, 0, 0}}, {{0, 0, 1}}});
    });
    expect_error(ErrorCode::InvalidMesh, "face 0", [] { weld({{}, {{0, 0, 0}}}); });
}

TEST(Weld, SurvivesNaN) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh welded =
        weld({{{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {0, 3, 2}}});
    EXPECT_EQ(welded.vertices.size(), 3U);
}

namespace {

template <typename Call>
void expect_refused(Call&& call) {
    expect_error(ErrorCode::InvalidOptions, "", call);
}

} // namespace

TEST(Generators, MakeThePapersTorus) {
    const TriangleMesh torus = make_torus(1, 0.4, 60, 24);
    EXPECT_EQ(torus.faces.size(), 2880U);
    EXPECT_EQ(torus.vertices.size(), 1440U);
    EXPECT_NEAR(winding_number(torus, {1, 0, 0}), 1, 1e-12);
    EXPECT_NEAR(winding_number(torus, {0, 0, 0}), 0, 1e-12);
    for (const Vec3f& p : torus.vertices)
        ASSERT_NEAR(std::hypot(std::hypot(p.x, p.y) - 1.0, double{p.z}), 0.4, 1e-7);
}

TEST(Generators, MakeASphereWithAllVerticesOnIt) {
    const TriangleMesh sphere = make_sphere(3, 60, 30);
    EXPECT_EQ(sphere.faces.size(), 2U * 60 * 29);
    EXPECT_EQ(sphere.vertices.size(), 60U * 29 + 2);
    for (const Vec3f& p : sphere.vertices) ASSERT_NEAR(length(Vec3d(p)), 3, 4e-7);
}

TEST(Generators, MakeABoxWithSharedEdges) {
    for (std::uint32_t segments : {1U, 2U, 5U}) {
        const TriangleMesh box = make_box({1, 2, 3}, segments);
        EXPECT_EQ(box.faces.size(), 12U * segments * segments);
        EXPECT_EQ(box.vertices.size(), 6U * segments * segments + 2); // Euler: V = 2 + F / 2
        EXPECT_NEAR(winding_number(box, {0.49, 0.99, 1.49}), 1, 1e-12);
        EXPECT_NEAR(winding_number(box, {0.51, 0.99, 1.49}), 0, 1e-12);
    }
}

TEST(Generators, RefuseSizesThatMakeNoSolid) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (double bad : {0.0, -1.0, 1.5, 1e-60, infinity, nan})
        expect_refused([&] { make_torus(1, bad, 8, 8); });
    for (double bad : {0.0, -1.0, 1e-60, 1e39, infinity, nan}) {
        expect_refused([&] { make_torus(bad, 0.1, 8, 8); });
        expect_refused([&] { make_sphere(bad, 8, 8); });
        expect_refused([&] { make_box({1, bad, 1}); });
    }
}

TEST(Generators, NameTheSizeThatIsTooLarge) {
    const double infinity = std::numeric_limits<double>::infinity();
    const auto expect_named = [](const char* sentence, const auto& call) {
        expect_error(ErrorCode::InvalidOptions, sentence, call);
    };
    expect_named("the major radius of a torus is inf; it must be positive and finite as a 32-bit float",
                 [&] { make_torus(infinity, 1, 8, 8); });
    expect_named("the outer radius of a torus, major + minor, is 5e+38",
                 [] { make_torus(3e38, 2e38, 8, 8); });
    expect_named("the radius of a sphere is inf", [&] { make_sphere(infinity, 8, 8); });
    expect_named("the edge length of a box is 1e+39", [] { make_box({1, 1e39, 1}); });
}

TEST(Generators, RefuseTooFewAndTooManySegments) {
    const std::uint32_t many = std::numeric_limits<std::uint32_t>::max();
    expect_refused([&] { make_torus(1, 0.4, 2, 8); });
    expect_refused([&] { make_torus(1, 0.4, 8, 2); });
    expect_refused([&] { make_torus(1, 0.4, many, many); });
    expect_refused([&] { make_sphere(1, 2, 8); });
    expect_refused([&] { make_sphere(1, 8, 1); });
    expect_refused([&] { make_sphere(1, many, many); });
    expect_refused([&] { make_box({1, 1, 1}, 0); });
    expect_refused([&] { make_box({1, 1, 1}, many); });
}

namespace {

Vec3d random_point(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> coordinate(-size, size);
    return {coordinate(random), coordinate(random), coordinate(random)};
}

/// Distance from a point to the surface of the box [-half, half].
double box_distance(const Vec3d& p, const Vec3d& half) {
    const Vec3d beyond{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3d outside{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
    const double inside = std::min(0.0, std::max({beyond.x, beyond.y, beyond.z}));
    return length(outside) - inside;
}

} // namespace

TEST(WindingNumber, IsOneInsideABoxAndZeroOutside) {
    std::mt19937 random(1);
    const TriangleMesh box = make_box({1, 2, 3}, 2);
    for (int i = 0; i < 500; ++i) {
        const Vec3d p = random_point(random, 2);
        const bool inside = std::abs(p.x) < 0.5 && std::abs(p.y) < 1 && std::abs(p.z) < 1.5;
        ASSERT_NEAR(winding_number(box, p), inside ? 1 : 0, 1e-12);
    }
}

TEST(WindingNumber, OfOneSideOfACubeSeenFromItsCentreIsASixth) {
    const TriangleMesh side{{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, {{0, 1, 2}, {0, 2, 3}}};
    EXPECT_NEAR(winding_number(side, {0, 0, 0}), 1.0 / 6, 1e-15);
    EXPECT_NEAR(winding_number(side, {0, 0, 2}), -1.0 / 6, 1e-15);
}

TEST(WindingNumber, OfTwoOverlappingBoxesIsTwoWhereTheyOverlap) {
    TriangleMesh both = make_box({2, 2, 2});
    const TriangleMesh other = both;
    for (const Vec3f& p : other.vertices) both.vertices.push_back(p + Vec3f{1, 0, 0});
    for (const Triangle& f : other.faces) both.faces.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
    EXPECT_NEAR(winding_number(both, {0.5, 0.1, 0.2}), 2, 1e-12);
    EXPECT_NEAR(winding_number(both, {-0.5, 0.1, 0.2}), 1, 1e-12);
}

TEST(WindingNumber, IsFiniteOnVerticesAndNotANumberForNaN) {
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_TRUE(std::isfinite(winding_number(box, Vec3d(box.vertices[0]))));
    EXPECT_TRUE(std::isnan(winding_number(box, {std::numeric_limits<double>::quiet_NaN(), 0, 0})));
}

TEST(UnsignedDistance, AgreesWithTheFormulaOfABox) {
    std::mt19937 random(2);
    const TriangleMesh box = make_box({1, 2, 3}, 3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d p = random_point(random, 2);
        ASSERT_NEAR(unsigned_distance(box, p), box_distance(p, {0.5, 1, 1.5}), 1e-14);
    }
}

TEST(UnsignedDistance, OfFacesWithoutAreaIsThatOfTheirEdges) {
    const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(unsigned_distance(needle, {1.5, 2, 0}), 2);
    EXPECT_EQ(unsigned_distance(needle, {3, 0, 0}), 1);
    const TriangleMesh dot{{{1, 1, 1}}, {{0, 0, 0}}};
    EXPECT_EQ(unsigned_distance(dot, {1, 1, 3}), 2);
}

TEST(UnsignedDistance, IsInfiniteWithoutFacesAndForNaN) {
    EXPECT_EQ(unsigned_distance({}, {0, 0, 0}), std::numeric_limits<double>::infinity());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(unsigned_distance(make_box({1, 1, 1}), {0, nan, 0}), std::numeric_limits<double>::infinity());
}

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double longest_side(const TriangleMesh& mesh) {
    return 2 * inspect(mesh).bounding_sphere.radius;
}

} // namespace

TEST(LocalFrame, LeavesMeshesWhereTheyAreAsLongAsFloatsHoldThem) {
    for (const TriangleMesh& mesh : shapes_far_away())
        for (const Vec3d& offset : {Vec3d{}, Vec3d{300, -20, 5}, Vec3d{0, 500, 0}}) {
            const TriangleMesh moved = local_mesh(positions_at(mesh, offset), mesh.faces);
            EXPECT_EQ(moved.origin, Vec3d{});
            for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
                EXPECT_EQ(moved.vertices[i], Vec3f(Vec3d(mesh.vertices[i]) + offset));
        }
}

TEST(LocalFrame, KeepsTheShapeOfMeshesFarAway) {
    for (const TriangleMesh& mesh : shapes_far_away())
        for (const Vec3d& offset : places_far_away()) {
            const std::vector<Vec3d> positions = positions_at(mesh, offset);
            const TriangleMesh moved = local_mesh(positions, mesh.faces);
            EXPECT_EQ(moved.faces, mesh.faces);
            EXPECT_NE(moved.origin, Vec3d{});
            const double rounding = longest_side(mesh) * 0x1p-24;
            for (std::size_t i = 0; i < positions.size(); ++i) {
                const Vec3d off = Vec3d(moved.vertices[i]) - (positions[i] - moved.origin);
                EXPECT_LE(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), rounding);
            }
        }
}

TEST(LocalFrame, GivesTheSameFloatsWhereverAMeshIsMovedOnTheGridOfItsOrigin) {
    const TriangleMesh box = make_box({1, 2, 3}, 4);
    const TriangleMesh here = local_mesh(positions_at(box, {1e6, 2e6, -3e6}), box.faces);
    const TriangleMesh there = local_mesh(positions_at(box, {1e9 + 1e6, -5e8 + 2e6, 7 - 3e6}), box.faces);
    EXPECT_EQ(there.vertices, here.vertices);
    EXPECT_EQ(there.origin, here.origin + Vec3d(1e9, -5e8, 7));
}

TEST(LocalFrame, HeedsOnlyPositionsThatAreUsedAndFinite) {
    const TriangleMesh box = make_box({1, 1, 1});
    std::vector<Vec3d> positions = positions_at(box, {0, 0, 0});
    positions.push_back({1e9, 1e9, 1e9}); // no face uses it
    EXPECT_EQ(local_mesh(positions, box.faces).origin, Vec3d{});

    positions = positions_at(box, {1e7, 0, 0});
    positions[3].y = kNan;
    EXPECT_EQ(local_mesh(positions, box.faces).origin, Vec3d(1e7, 0, 0));
    EXPECT_EQ(local_mesh(positions, {Triangle{0, 1, 77}}).faces[0][2], 77U); // inspect() refuses it
    EXPECT_EQ(local_mesh({}, {}).origin, Vec3d{});
}

TEST(LocalFrame, IsKeptByWhatChangesAMesh) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh far = local_mesh(positions_at(box, {1e7, 2e7, 3e7}), box.faces);
    const Vec3d origin = far.origin;
    far.faces.pop_back();
    EXPECT_EQ(weld(far).origin, origin);
    const TriangleMesh closed = repair(far, {.max_hole_edges = 8}).mesh;
    EXPECT_EQ(closed.origin, origin);
    EXPECT_NEAR(inspect(closed).signed_volume, 1, 1e-6);
}

TEST(LocalFrame, MustBeTheSameForMeshesThatAreCompared) {
    const TriangleMesh box = make_box({1, 1, 1});
    const TriangleMesh far = local_mesh(positions_at(box, {1e7, 2e7, 3e7}), box.faces);
    EXPECT_FALSE(intersecting_pairs(far, far).empty());
    expect_error(ErrorCode::InvalidMesh, "different origins", [&] { intersecting_pairs(far, box); });
}

TEST(LocalFrame, OfAMeshThatCameAsFloatsIsReportedWithTheirStep) {
    const TriangleMesh box = make_box({1, 0.9, 0.8});
    const std::vector<Vec3d> exact = positions_at(box, {448262, 5411932, 112});
    std::vector<Vec3d> rounded;
    for (const Vec3d& position : exact) rounded.emplace_back(Vec3f(position));
    EXPECT_EQ(inspect(local_mesh(rounded, box.faces)).rounding_step, 0.5);
    EXPECT_EQ(inspect({std::vector<Vec3f>(rounded.begin(), rounded.end()), box.faces}).rounding_step, 0.5);
    EXPECT_EQ(inspect(local_mesh(exact, box.faces)).rounding_step, 0);
    EXPECT_NEAR(inspect(local_mesh(exact, box.faces)).signed_volume, 0.72, 1e-7);
    EXPECT_EQ(inspect(box).rounding_step, 0);
}

namespace {

using Random = std::mt19937;

std::vector<Vec3f> random_points(Random& random, std::size_t count, const Vec3f& size) {
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i)
        points.emplace_back(size.x * unit(random), size.y * unit(random), size.z * unit(random));
    return points;
}

/// Distance from a centre to the farthest point: the radius of the smallest sphere around that centre.
double farthest(const std::vector<Vec3f>& points, const Vec3d& centre) {
    double radius = 0;
    for (const Vec3f& p : points) radius = std::max(radius, length(Vec3d(p) - centre));
    return radius;
}

// The oracle: Cramer's rule in long double over all subsets of two to four points. It shares neither the
// search nor the solver with the function under test.
struct Long {
    long double x, y, z;
};
Long minus(const Vec3f& a, const Vec3f& b) {
    return {(long double)a.x - b.x, (long double)a.y - b.y, (long double)a.z - b.z};
}
long double dot(const Long& a, const Long& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Long cross(const Long& a, const Long& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The point equally far from the origin, a, b and c; not finite when they are coplanar.
Vec3d equidistant(const Long& a, const Long& b, const Long& c) {
    const long double scale = 1 / (2 * dot(a, cross(b, c)));
    const Long bc = cross(b, c);
    const Long ca = cross(c, a);
    const Long ab = cross(a, b);
    const auto along = [&](long double u, long double v, long double w) {
        return static_cast<double>((dot(a, a) * u + dot(b, b) * v + dot(c, c) * w) * scale);
    };
    return {along(bc.x, ca.x, ab.x), along(bc.y, ca.y, ab.y), along(bc.z, ca.z, ab.z)};
}

/// The same for three points, in their plane: a sphere through 0, a and b that is cut in half by it.
Vec3d equidistant(const Long& a, const Long& b) {
    const Long n = cross(a, b);
    const long double scale = 1 / (2 * dot(n, n));
    const Long nb = cross(b, n);
    const Long na = cross(n, a);
    const auto along = [&](long double u, long double v) {
        return static_cast<double>((dot(a, a) * u + dot(b, b) * v) * scale);
    };
    return {along(nb.x, na.x), along(nb.y, na.y), along(nb.z, na.z)};
}

double brute_force_radius(const std::vector<Vec3f>& points) {
    double best = std::numeric_limits<double>::infinity();
    const auto try_centre = [&](const Vec3f& origin, const Vec3d& offset) {
        const Vec3d centre = Vec3d(origin) + offset;
        if (is_finite(centre)) best = std::min(best, farthest(points, centre));
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
        try_centre(points[i], {});
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            const Long a = minus(points[j], points[i]);
            try_centre(points[i], Vec3d{double(a.x / 2), double(a.y / 2), double(a.z / 2)});
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                const Long b = minus(points[k], points[i]);
                try_centre(points[i], equidistant(a, b));
                for (std::size_t l = k + 1; l < points.size(); ++l)
                    try_centre(points[i], equidistant(a, b, minus(points[l], points[i])));
            }
        }
    }
    return best;
}

} // namespace

TEST(EnclosingSphere, IsAsSmallAsTheBestOfAllSubsets) {
    Random random(1);
    for (const Vec3f size : {Vec3f{1, 1, 1}, Vec3f{1e9F, 1e9F, 1e9F}, Vec3f{1e-9F, 1e-9F, 1e-9F},
                             Vec3f{1, 1, 1e-6F}, Vec3f{1, 1e-6F, 1e-6F}, Vec3f{1, 1, 0}, Vec3f{1, 0, 0}})
        for (int round = 0; round < 60; ++round) {
            const auto points = random_points(random, 1 + random() % 9, size);
            const double expected = brute_force_radius(points);
            ASSERT_NEAR(smallest_enclosing_sphere(points).radius, expected, 1e-14 * expected);
        }
}

TEST(EnclosingSphere, SurvivesPointsOnALatticeWithDuplicatesAndCospherical) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<Vec3f> points;
        for (unsigned i = 0, count = 2 + random() % 8; i < count; ++i)
            points.emplace_back(float(random() % 3), float(random() % 3), float(random() % 2));
        const double expected = brute_force_radius(points);
        ASSERT_NEAR(smallest_enclosing_sphere(points).radius, expected, 1e-14 * expected);
    }
}

TEST(EnclosingSphere, EnclosesEveryPointAsComputedInDouble) {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        auto points = random_points(random, 1000, {3, 2, 1});
        for (Vec3f& p : points) p += Vec3f{100, -200, 300};
        const Sphere sphere = smallest_enclosing_sphere(points);
        ASSERT_EQ(farthest(points, sphere.centre), sphere.radius);
    }
}

TEST(EnclosingSphere, CannotShrinkByMovingItsCentre) {
    Random random(4);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 60, 24), make_sphere(2, 40, 20), make_box({1, 2, 3}, 4)}) {
        const Sphere sphere = smallest_enclosing_sphere(mesh.vertices);
        for (double step : {1e-1, 1e-3, 1e-5})
            for (int i = 0; i < 50; ++i) {
                const Vec3d moved = sphere.centre + Vec3d{unit(random), unit(random), unit(random)} * step;
                ASSERT_GE(farthest(mesh.vertices, moved), sphere.radius * (1 - 1e-15));
            }
    }
}

TEST(EnclosingSphere, IsThatOfTheFormulaForABoxAndASegment) {
    const Sphere box = smallest_enclosing_sphere(make_box({2, 4, 4}, 3).vertices);
    EXPECT_NEAR(box.radius, 3, 1e-15);
    EXPECT_NEAR(length(box.centre), 0, 1e-15);
    const Sphere segment = smallest_enclosing_sphere(std::array{Vec3f{1, 1, 1}, Vec3f{1, 1, 5}});
    EXPECT_EQ(segment.radius, 2);
    EXPECT_EQ(segment.centre, (Vec3d{1, 1, 3}));
}

TEST(EnclosingSphere, OfOnePointOrEqualPointsHasRadiusZero) {
    const std::vector<Vec3f> equal(5, Vec3f{1e9F, -3, 1e-9F});
    for (std::size_t count : {1U, 5U}) {
        const Sphere sphere = smallest_enclosing_sphere(std::span(equal).first(count));
        EXPECT_EQ(sphere.radius, 0);
        EXPECT_EQ(sphere.centre, Vec3d(equal[0]));
    }
}

TEST(EnclosingSphere, OfNoPointsIsAtTheOrigin) {
    const Sphere sphere = smallest_enclosing_sphere({});
    EXPECT_EQ(sphere.radius, 0);
    EXPECT_EQ(sphere.centre, Vec3d{});
}

TEST(EnclosingSphere, HandlesTheLargestAndSmallestFloats) {
    const float huge = std::numeric_limits<float>::max();
    const float tiny = std::numeric_limits<float>::denorm_min();
    for (float size : {huge, tiny}) {
        const std::vector<Vec3f> corners{{-size, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, -size}};
        EXPECT_NEAR(smallest_enclosing_sphere(corners).radius / size, 1, 1e-15);
    }
}

TEST(EnclosingSphere, DoesNotDependOnTheOrderOfPointsBeyondRounding) {
    Random random(5);
    auto points = random_points(random, 300, {1, 1, 1});
    const Sphere first = smallest_enclosing_sphere(points);
    std::shuffle(points.begin(), points.end(), random);
    const Sphere second = smallest_enclosing_sphere(points);
    EXPECT_NEAR(first.radius, second.radius, 1e-15);
    EXPECT_NEAR(length(first.centre - second.centre), 0, 1e-13);
}
