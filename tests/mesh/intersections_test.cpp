#include "mesh/intersecting_pairs.hpp"
#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/intersections.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

using namespace echinus;
using namespace echinus::test;

namespace {

using Corners = std::array<Vec3f, 3>;
using Pairs = std::vector<FacePair>;

// ---- A judge that works another way: linear programming in whole numbers ----
//
// Two triangles meet where a point of one is a point of the other. Both are the intersections of half-spaces,
// so Fourier and Motzkin's elimination decides; it knows nothing of planes, edges and degenerate cases.

__extension__ using Int = __int128;

/// coefficients . (s, t, u, v) <= bound
struct Inequality {
    std::array<Int, 4> coefficients;
    Int bound;
};

Int gcd(Int a, Int b) {
    while (b != 0) a = std::exchange(b, a % b);
    return a < 0 ? -a : a;
}

void reduce(Inequality& row) {
    Int divisor = row.bound;
    for (const Int c : row.coefficients) divisor = gcd(divisor, c);
    if (divisor < 0) divisor = -divisor;
    if (divisor <= 1) return;
    for (Int& c : row.coefficients) c /= divisor;
    row.bound /= divisor;
}

bool feasible(std::vector<Inequality> rows) {
    for (std::size_t k = 0; k < 4; ++k) {
        std::vector<Inequality> next;
        for (const Inequality& p : rows) {
            if (p.coefficients[k] == 0) next.push_back(p);
            if (p.coefficients[k] <= 0) continue;
            for (const Inequality& q : rows) {
                if (q.coefficients[k] >= 0) continue;
                Inequality sum;
                const Int from_p = -q.coefficients[k], from_q = p.coefficients[k];
                for (std::size_t i = 0; i < 4; ++i)
                    sum.coefficients[i] = from_p * p.coefficients[i] + from_q * q.coefficients[i];
                sum.bound = from_p * p.bound + from_q * q.bound;
                reduce(sum);
                next.push_back(sum);
            }
        }
        // Of equal left sides the smallest bound decides.
        std::sort(next.begin(), next.end(), [](const Inequality& p, const Inequality& q) {
            return std::tie(p.coefficients, p.bound) < std::tie(q.coefficients, q.bound);
        });
        next.erase(std::unique(next.begin(), next.end(),
                               [](const Inequality& p, const Inequality& q) {
                                   return p.coefficients == q.coefficients;
                               }),
                   next.end());
        rows = std::move(next);
    }
    return std::all_of(rows.begin(), rows.end(), [](const Inequality& row) { return row.bound >= 0; });
}

/// a0 + s (a1 - a0) + t (a2 - a0) = b0 + u (b1 - b0) + v (b2 - b0) with s, t, u, v, 1 - s - t, 1 - u - v >=
/// 0.
bool meet_by_elimination(const Corners& a, const Corners& b) {
    std::vector<Inequality> rows{{{-1, 0, 0, 0}, 0}, {{0, -1, 0, 0}, 0}, {{1, 1, 0, 0}, 1},
                                 {{0, 0, -1, 0}, 0}, {{0, 0, 0, -1}, 0}, {{0, 0, 1, 1}, 1}};
    for (float Vec3f::*c : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
        const auto whole = [&](const Vec3f& p) { return static_cast<Int>(p.*c); };
        Inequality row{{whole(a[1]) - whole(a[0]), whole(a[2]) - whole(a[0]), whole(b[0]) - whole(b[1]),
                        whole(b[0]) - whole(b[2])},
                       whole(b[0]) - whole(a[0])};
        rows.push_back(row);
        for (Int& k : row.coefficients) k = -k;
        row.bound = -row.bound;
        rows.push_back(row);
    }
    return feasible(std::move(rows));
}

// ---- Triangles with many coincidences ----

Corners whole_triangle(Random& random, int half_width) {
    const Vec3f a = whole_point(random, half_width), b = whole_point(random, half_width);
    return {a, b, whole_point(random, half_width)};
}

Corners moved(Corners t, const Vec3f& offset) {
    for (Vec3f& p : t) p += offset;
    return t;
}

Corners scaled(Corners t, float factor) {
    for (Vec3f& p : t) p = p * factor;
    return t;
}

Corners corners_of(const TriangleMesh& mesh, std::size_t face) {
    const auto& [a, b, c] = mesh.faces[face];
    return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

// ---- Meshes ----

TriangleMesh grid(std::uint32_t side, float size, const Vec3f& origin) {
    TriangleMesh mesh;
    const float step = size / static_cast<float>(side - 1);
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i)
            mesh.vertices.push_back(origin +
                                    Vec3f{static_cast<float>(i) * step, static_cast<float>(j) * step, 0});
    for (std::uint32_t j = 0; j + 1 < side; ++j)
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t k = j * side + i;
            mesh.faces.push_back({k, k + 1, k + side});
            mesh.faces.push_back({k + 1, k + side + 1, k + side});
        }
    return mesh;
}

Pairs pairs_one_by_one(const TriangleMesh& a, const TriangleMesh& b) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < a.faces.size(); ++i)
        for (std::uint32_t j = 0; j < b.faces.size(); ++j)
            if (triangles_intersect(corners_of(a, i), corners_of(b, j))) pairs.push_back({i, j});
    return pairs;
}

/// All pairs of corners, edges and faces without a common vertex, by the judge above.
bool parts_meet(const TriangleMesh& mesh, const Triangle& a, const Triangle& b) {
    Triangle p = a, q = b;
    std::sort(p.begin(), p.end());
    std::sort(q.begin(), q.end());
    if (std::equal(p.begin(), std::unique(p.begin(), p.end()), q.begin(), std::unique(q.begin(), q.end())))
        return true;
    const auto part_of = [](const Triangle& face, unsigned mask) {
        std::vector<std::uint32_t> part;
        for (unsigned k = 0; k < 3; ++k)
            if ((mask >> k & 1) != 0) part.push_back(face[k]);
        return part;
    };
    const auto hull = [&](const std::vector<std::uint32_t>& part) {
        return Corners{mesh.vertices[part.front()], mesh.vertices[part[part.size() / 2]],
                       mesh.vertices[part.back()]};
    };
    for (unsigned i = 1; i < 8; ++i)
        for (unsigned j = 1; j < 8; ++j) {
            const auto a_part = part_of(a, i), b_part = part_of(b, j);
            if (std::find_first_of(a_part.begin(), a_part.end(), b_part.begin(), b_part.end()) ==
                    a_part.end() &&
                meet_by_elimination(hull(a_part), hull(b_part)))
                return true;
        }
    return false;
}

Pairs own_pairs_one_by_one(const TriangleMesh& mesh) {
    Pairs pairs;
    for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
        for (std::uint32_t j = i + 1; j < mesh.faces.size(); ++j)
            if (parts_meet(mesh, mesh.faces[i], mesh.faces[j])) pairs.push_back({i, j});
    return pairs;
}

} // namespace

// ---- Two triangles ----

TEST(TrianglesIntersect, AgreesWithEliminationOnWholeNumbersWithManyCoincidences) {
    Random random(1);
    for (const int half_width : {1, 2, 3, 10}) {
        int meeting = 0;
        for (int i = 0; i < 3000; ++i) {
            const Corners a = whole_triangle(random, half_width), b = whole_triangle(random, half_width);
            const bool expected = meet_by_elimination(a, b);
            ASSERT_EQ(triangles_intersect(a, b), expected) << "case " << i << " of width " << half_width;
            meeting += expected;
        }
        EXPECT_GT(meeting, 300);
        EXPECT_LT(meeting, 2900);
    }
}

TEST(TrianglesIntersect, IsTheSameForEveryOrderOfCornersAndTriangles) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        Corners a = whole_triangle(random, 2), b = whole_triangle(random, 2);
        const bool expected = triangles_intersect(a, b);
        std::array<int, 3> order{0, 1, 2};
        do {
            const Corners turned{a[order[0]], a[order[1]], a[order[2]]};
            ASSERT_EQ(triangles_intersect(turned, b), expected);
            ASSERT_EQ(triangles_intersect(b, turned), expected);
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(TrianglesIntersect, IsUnchangedByShiftsAndScalesThatFloatsCanHold) {
    Random random(3);
    for (int i = 0; i < 5000; ++i) {
        const Corners a = whole_triangle(random, 3), b = whole_triangle(random, 3);
        const bool expected = triangles_intersect(a, b);
        const Vec3f offset{8'000'000, -3'000'000, 5'000'001};
        ASSERT_EQ(triangles_intersect(moved(a, offset), moved(b, offset)), expected);
        for (const int exponent : {-149, -140, -100, 60, 125})
            ASSERT_EQ(triangles_intersect(scaled(a, std::ldexp(1.0F, exponent)),
                                          scaled(b, std::ldexp(1.0F, exponent))),
                      expected);
    }
}

// A triangle whose planes and edges hold points that no sum in double can place: the differences are rounded.
TEST(TrianglesIntersect, IsExactWhereCoordinatesDifferByManyPowersOfTwo) {
    const float tiny = std::numeric_limits<float>::denorm_min(), huge = std::ldexp(1.0F, 126);
    for (const float size : {1.0F, 1e10F, huge}) {
        const Corners plane{{{-size, -size, tiny}, {size, -size, tiny}, {0, size, tiny}}};
        EXPECT_TRUE(triangles_intersect(plane, {{{0, 0, tiny}, {size, 0, size}, {0, size, size}}}));
        EXPECT_FALSE(triangles_intersect(plane, {{{0, 0, 2 * tiny}, {size, 0, size}, {0, size, size}}}));
        EXPECT_TRUE(triangles_intersect(plane, {{{0, 0, 0}, {size, 0, size}, {0, size, size}}}));
        EXPECT_FALSE(triangles_intersect(plane, {{{0, 0, 0}, {size, 0, -size}, {0, size, -size}}}));
        // A tilted plane x + y + z = tiny through (size, -size, tiny) and its turns, and points beside it.
        const Corners tilted{{{size, -size, tiny}, {-size, tiny, size}, {tiny, size, -size}}};
        EXPECT_TRUE(triangles_intersect(tilted, {{{0, 0, tiny}, {size, 0, tiny}, {0, size, tiny}}}));
        EXPECT_FALSE(triangles_intersect(tilted, {{{tiny, 0, tiny}, {size, 0, tiny}, {0, size, tiny}}}));
        EXPECT_FALSE(triangles_intersect(tilted, {{{0, 0, 0}, {-tiny, 0, 0}, {0, 0, -tiny}}}));
    }
}

TEST(TrianglesIntersect, IsFalseForWhatIsNotFinite) {
    const Corners t{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (int corner = 0; corner < 3; ++corner)
            for (float Vec3f::*c : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) {
                Corners spoilt = t;
                spoilt[corner].*c = bad;
                EXPECT_FALSE(triangles_intersect(t, spoilt));
                EXPECT_FALSE(triangles_intersect(spoilt, t));
            }
}

// ---- Two meshes ----

TEST(IntersectingPairs, AreThoseFoundOneByOne) {
    Random random(4);
    for (int i = 0; i < 50; ++i) {
        const TriangleMesh a = random_soup(random, 60, 80, 10), b = random_soup(random, 40, 60, 8);
        const Pairs expected = pairs_one_by_one(a, b);
        EXPECT_FALSE(expected.empty());
        ASSERT_EQ(intersecting_pairs(a, b), expected);
    }
    const TriangleMesh torus = make_torus(1, 0.4, 30, 12);
    const TriangleMesh sheet = grid(20, 4, {-2, -2, 0.1F});
    const Pairs expected = pairs_one_by_one(torus, sheet);
    EXPECT_GT(expected.size(), 100U);
    EXPECT_EQ(intersecting_pairs(torus, sheet), expected);
}

TEST(IntersectingPairs, OfAMeshAndItsCopyAreThoseFoundOneByOne) {
    for (const TriangleMesh& mesh :
         {make_torus(1, 0.4, 20, 9), make_sphere(1, 16, 9), make_box({1, 2, 3}, 4), grid(14, 1, {})}) {
        const Pairs expected = pairs_one_by_one(mesh, mesh);
        EXPECT_GT(expected.size(), 6 * mesh.faces.size());
        EXPECT_EQ(intersecting_pairs(mesh, mesh), expected);
    }
}

// The middle of a box leaves nearly all faces on one side, at every level of the tree.
TEST(IntersectingPairs, AreFoundWhereFacesCrowdTogether) {
    TriangleMesh a, b;
    for (int k = 0; k < 100; ++k) {
        const float size = std::ldexp(1.0F, k - 50);
        for (TriangleMesh* mesh : {&a, &b}) {
            const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
            for (const Vec3f& p : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}})
                mesh->vertices.push_back(p * size);
            mesh->faces.push_back({first, first + 1, first + 2});
        }
        b.vertices.back() = {size, size, size};
    }
    const Pairs expected = pairs_one_by_one(a, b);
    EXPECT_GE(expected.size(), 100U);
    EXPECT_EQ(intersecting_pairs(a, b), expected);
}

TEST(IntersectingPairs, OfBoxesThatTouchAreThoseOfTheCommonSideAndOfBoxesApartNone) {
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    EXPECT_TRUE(intersecting_pairs(box, translated(box, {1.0001F, 0, 0})).empty());
    const Pairs touching = intersecting_pairs(box, translated(box, {1, 0, 0}));
    EXPECT_FALSE(touching.empty());
    EXPECT_EQ(touching, pairs_one_by_one(box, translated(box, {1, 0, 0})));
}

TEST(IntersectingPairs, AreFoundBesideAFaceThatReachesToTheEndsOfTheFloats) {
    TriangleMesh sheet = grid(60, 2, {-1, -1, 0});
    const auto first = static_cast<std::uint32_t>(sheet.vertices.size());
    const float far = std::numeric_limits<float>::max();
    for (const Vec3f& p : {Vec3f{-far, -far, 5}, Vec3f{far, -far, 5}, Vec3f{0, far, 5}})
        sheet.vertices.push_back(p);
    sheet.faces.push_back({first, first + 1, first + 2});
    const TriangleMesh box = make_box({0.5, 0.5, 11}, 3);
    const Pairs pairs = intersecting_pairs(sheet, box);
    EXPECT_EQ(pairs, pairs_one_by_one(sheet, box));
    EXPECT_EQ(pairs.back().a, sheet.faces.size() - 1);
}

TEST(IntersectingPairs, RefuseMeshesThatNoOtherFunctionTakes) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh no_vertex = box, not_finite = box;
    no_vertex.faces[3][1] = 8;
    not_finite.vertices[2].y = std::numeric_limits<float>::quiet_NaN();
    expect_error(ErrorCode::InvalidMesh, "face 3", [&] { intersecting_pairs(box, no_vertex); });
    expect_error(ErrorCode::InvalidMesh, "vertex 2", [&] { intersecting_pairs(not_finite, box); });
    expect_error(ErrorCode::InvalidMesh, "no faces", [&] { intersecting_pairs(box, {}); });
    expect_error(ErrorCode::InvalidMesh, "face 3", [&] { self_intersecting_pairs(no_vertex); });
    expect_error(ErrorCode::InvalidMesh, "vertex 2", [&] { self_intersecting_pairs(not_finite); });
    expect_error(ErrorCode::InvalidMesh, "no faces", [&] { self_intersecting_pairs({}); });
}

TEST(IntersectingPairs, AreRefusedBeyondALimit) {
    const TriangleMesh box = make_box({1, 1, 1}, 2), other = translated(box, {0.3F, 0.2F, 0.1F});
    const std::size_t count = intersecting_pairs(box, other).size();
    EXPECT_EQ(intersecting_pairs(box, other, count), intersecting_pairs(box, other));
    expect_error(ErrorCode::InvalidMesh, "more than " + std::to_string(count - 1) + " pairs of faces",
                 [&] { intersecting_pairs(box, other, count - 1); });
    TriangleMesh doubled = box;
    doubled.faces.push_back(box.faces[0]);
    expect_error(ErrorCode::InvalidMesh, "check parts", [&] { self_intersecting_pairs(doubled, 0); });
}

// ---- A mesh with itself ----

TEST(SelfIntersectingPairs, OfProperSurfacesAreNone) {
    EXPECT_TRUE(self_intersecting_pairs(make_torus(1, 0.4, 60, 24)).empty());
    EXPECT_TRUE(self_intersecting_pairs(make_sphere(1, 20, 11)).empty());
    EXPECT_TRUE(self_intersecting_pairs(make_box({1, 2, 3}, 4)).empty());
    EXPECT_TRUE(self_intersecting_pairs(grid(30, 1, {})).empty());
}

TEST(SelfIntersectingPairs, AreThePartsWithoutCommonVertexThatMeetByElimination) {
    Random random(5);
    std::size_t found = 0, all = 0;
    for (int i = 0; i < 24; ++i) {
        const TriangleMesh mesh = random_soup(random, 9, 14, i % 3 + 1);
        const Pairs expected = own_pairs_one_by_one(mesh);
        ASSERT_EQ(self_intersecting_pairs(mesh), expected);
        found += expected.size();
        all += mesh.faces.size() * (mesh.faces.size() - 1) / 2;
    }
    EXPECT_GT(found, all / 10);
    EXPECT_LT(found, all * 9 / 10);
}

//   c---b      Faces abc and adb are neighbours across ab; d is moved round to the side of c.
//   | \ |
//   a   d
TEST(SelfIntersectingPairs, OfNeighboursAcrossAnEdgeAreThoseFoldedFlat) {
    TriangleMesh fold{{{0, 0, 0}, {1, 0, 0}, {0.3F, 1, 0}, {0.3F, -1, 0}}, {{0, 1, 2}, {0, 3, 1}}};
    EXPECT_TRUE(self_intersecting_pairs(fold).empty());
    fold.vertices[3] = {0.4F, 0.5F, std::numeric_limits<float>::denorm_min()};
    EXPECT_TRUE(self_intersecting_pairs(fold).empty());
    fold.vertices[3].z = 0;
    EXPECT_EQ(self_intersecting_pairs(fold), (Pairs{{0, 1}}));
    fold.vertices[3] = {5, 0.5F, 0}; // neither's corner lies in the other, but edges cross
    EXPECT_EQ(self_intersecting_pairs(fold), (Pairs{{0, 1}}));
}

TEST(SelfIntersectingPairs, OfFacesAtOneVertexAreThoseThatMeetAnywhereElse) {
    TriangleMesh bow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
    EXPECT_TRUE(self_intersecting_pairs(bow).empty());
    bow.vertices[3] = {2, 1, 1};
    bow.vertices[4] = {2, 1, -1}; // now passes through the first face, and its far edge beyond it
    EXPECT_EQ(self_intersecting_pairs(bow), (Pairs{{0, 1}}));
    bow.vertices[3] = {0.5F, 0.25F, 0};
    bow.vertices[4] = {0.5F, 0.25F, 1}; // stands on it
    EXPECT_EQ(self_intersecting_pairs(bow), (Pairs{{0, 1}}));
}

TEST(SelfIntersectingPairs, TakeEdgesWithoutFacesAsFacesWithTwoEqualCorners) {
    TriangleMesh sheet = grid(10, 1, {});
    const auto first = static_cast<std::uint32_t>(sheet.vertices.size());
    for (const float z : {0.5F, 0.1F, -0.1F, -0.5F}) sheet.vertices.push_back({0.51F, 0.53F, z});
    const auto thread = static_cast<std::uint32_t>(sheet.faces.size());
    for (std::uint32_t i = 0; i < 3; ++i) sheet.faces.push_back({first + i, first + i + 1, first + i + 1});
    const Pairs pairs = self_intersecting_pairs(sheet);
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_EQ(pairs[0].b, thread + 1);
}

// ---- Curves ----

namespace {

std::size_t open_count(const Intersections& found) {
    return static_cast<std::size_t>(std::count_if(found.curves.begin(), found.curves.end(),
                                                  [](const IntersectionCurve& c) { return !c.closed; }));
}

/// The distance of a point from the plane of a face.
double distance_to_plane(const Vec3f& point, const Corners& face) {
    const Vec3d origin(face[0]);
    const Vec3d normal = cross(Vec3d(face[1]) - origin, Vec3d(face[2]) - origin);
    return std::abs(dot(normal, Vec3d(point) - origin)) / length(normal);
}

/// In the planes of both faces of some pair.
bool lies_on_a_pair(const Vec3f& point, const Intersections& found, const TriangleMesh& a,
                    const TriangleMesh& b) {
    return std::any_of(found.pairs.begin(), found.pairs.end(), [&](const FacePair& pair) {
        return distance_to_plane(point, corners_of(a, pair.a)) < 1e-6 &&
               distance_to_plane(point, corners_of(b, pair.b)) < 1e-6;
    });
}

} // namespace

TEST(IntersectionCurves, OfTwoSpheresAreTheCircleInWhichTheyCross) {
    const TriangleMesh a = make_sphere(1, 120, 61), b = translated(make_sphere(1, 90, 45), {1, 0.01F, 0.02F});
    const Intersections found = intersections(a, b);
    EXPECT_EQ(found.pairs, intersecting_pairs(a, b));
    ASSERT_EQ(found.curves.size(), 1U);
    EXPECT_TRUE(found.curves[0].closed);
    EXPECT_NEAR(found.length, 2 * 3.14159265 * std::sqrt(0.75), 0.01);
    for (const Vec3f& point : found.curves[0].points) ASSERT_TRUE(lies_on_a_pair(point, found, a, b));
}

// All edges of one meet edges, diagonals and corners of the other: three of its own edges for each corner.
TEST(IntersectionCurves, AreClosedWhereEdgesMeetEdgesAndCornersFaces) {
    const TriangleMesh box = make_box({2, 2, 2});
    for (const std::uint32_t segments : {1U, 2U, 4U}) {
        const Intersections found = intersections(make_box({2, 2, 2}, segments), translated(box, {1, 1, 1}));
        ASSERT_EQ(found.curves.size(), 1U) << segments;
        EXPECT_TRUE(found.curves[0].closed);
        EXPECT_DOUBLE_EQ(found.length, 6);
    }
}

TEST(IntersectionCurves, OfClosedMeshesInGeneralPositionAreClosed) {
    Random random(6);
    for (int i = 0; i < 40; ++i) {
        const TriangleMesh a = make_torus(1, 0.4, 13, 7);
        const TriangleMesh b = translated(make_sphere(0.8, 11, 7), in_cube(random, 1));
        const Intersections found = intersections(a, b);
        EXPECT_EQ(open_count(found), 0U);
        EXPECT_EQ(found.curves.empty(), found.pairs.empty());
        const Intersections turned = intersections(b, a);
        EXPECT_EQ(turned.curves.size(), found.curves.size());
        EXPECT_NEAR(turned.length, found.length, 1e-5);
    }
}

TEST(IntersectionCurves, EndAtTheBorderOfAnOpenSurface) {
    const Intersections found = intersections(grid(11, 1, {0, 0, 0}), make_sphere(0.5, 40, 21));
    ASSERT_EQ(found.curves.size(), 1U);
    EXPECT_FALSE(found.curves[0].closed);
    EXPECT_NEAR(found.length, 3.14159265 / 4, 0.01); // a quarter of the circle
    EXPECT_NEAR(found.curves[0].points.front().x * found.curves[0].points.back().x, 0, 1e-6);
}

TEST(IntersectionCurves, AreNoneWhereFacesOnlyLieOnEachOtherOrTouchInAPoint) {
    const TriangleMesh sheet = grid(5, 1, {});
    TriangleMesh one = sheet;
    one.faces = {sheet.faces[0]};
    const Intersections flat = intersections(one, sheet);
    EXPECT_FALSE(flat.pairs.empty());
    EXPECT_TRUE(flat.curves.empty());
    const TriangleMesh needle{{{0.3F, 0.4F, 0}, {0.3F, 0.5F, 1}, {0.4F, 0.5F, 1}}, {{0, 1, 2}}};
    const Intersections touching = intersections(sheet, needle);
    EXPECT_FALSE(touching.pairs.empty());
    EXPECT_TRUE(touching.curves.empty());
    TriangleMesh thread{{{0.3F, 0.4F, -1}, {0.3F, 0.5F, 1}}, {{0, 1, 1}}};
    EXPECT_EQ(intersections(sheet, thread).pairs.size(), 1U);
    EXPECT_TRUE(intersections(sheet, thread).curves.empty());
}

// Two sheets of one mesh cross; and a strip folds through itself next to the vertex that its faces share.
TEST(IntersectionCurves, OfAMeshWithItselfAreThoseOfItsParts) {
    const TriangleMesh a = make_sphere(1, 30, 15), b = translated(make_sphere(1, 24, 13), {0.9F, 0.1F, 0});
    TriangleMesh both = a;
    for (const Vec3f& v : b.vertices) both.vertices.push_back(v);
    const auto offset = static_cast<std::uint32_t>(a.vertices.size());
    for (const Triangle& f : b.faces) both.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    const Intersections own = self_intersections(both), of_two = intersections(a, b);
    EXPECT_EQ(own.pairs.size(), of_two.pairs.size());
    EXPECT_EQ(own.curves.size(), of_two.curves.size());
    EXPECT_EQ(open_count(own), 0U);
    EXPECT_NEAR(own.length, of_two.length, 1e-6);
    const TriangleMesh fan{{{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {2, 0, -1}, {2, 0, 1}}, {{0, 1, 2}, {0, 3, 4}}};
    const Intersections at_a_vertex = self_intersections(fan);
    ASSERT_EQ(at_a_vertex.curves.size(), 1U);
    EXPECT_EQ(at_a_vertex.curves[0].points.size(), 2U);
    EXPECT_DOUBLE_EQ(at_a_vertex.length, 2);
}

TEST(IntersectionCurves, HaveFiniteEndsWhateverTheFaces) {
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        const TriangleMesh mesh = random_soup(random, 10, 20, i % 4 + 1);
        for (const Intersections& found : {self_intersections(mesh), intersections(mesh, mesh)}) {
            EXPECT_TRUE(std::isfinite(found.length));
            for (const IntersectionCurve& curve : found.curves) {
                ASSERT_GE(curve.points.size(), 2U);
                for (const Vec3f& point : curve.points) ASSERT_TRUE(is_finite(point));
            }
        }
    }
}
