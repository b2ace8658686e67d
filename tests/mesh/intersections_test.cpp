#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/intersections.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
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
