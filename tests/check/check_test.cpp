#include "support/expectations.hpp"
#include "support/meshes.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/intersections.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

using namespace echinus;
using namespace echinus::test;

TEST(Check, FindsWhichMeshesIntersectAndHowDeep) {
    const TriangleMesh ball = make_sphere(1, 60, 30);
    const std::vector<TriangleMesh> meshes{ball, translated(ball, {5, 0, 0}), translated(ball, {1.5F, 0, 0})};
    const std::vector<CheckedMeshes> found = check(meshes);
    ASSERT_EQ(found.size(), 1U);
    const CheckedMeshes& pair = found[0];
    EXPECT_EQ(pair.a, 0U);
    EXPECT_EQ(pair.b, 2U);
    EXPECT_TRUE(pair.intersect());
    EXPECT_EQ(pair.found.pairs, intersecting_pairs(meshes[0], meshes[2]));
    for (const Penetration& penetration : {pair.a_in_b, pair.b_in_a}) {
        EXPECT_TRUE(penetration.known);
        EXPECT_GT(penetration.vertex_count, 10U);
        EXPECT_NEAR(penetration.depth, 0.5, 0.01); // the poles of the overlap are 0.5 apart
    }
    const Vec3f deepest = meshes[0].vertices[pair.a_in_b.deepest_vertex];
    EXPECT_NEAR(deepest.x, 1, 1e-3);
}

TEST(Check, FindsTheDeepestOfAllVertices) {
    Random random(1);
    for (int i = 0; i < 30; ++i) {
        const std::vector<TriangleMesh> meshes{make_torus(1, 0.4, 31, 17),
                                               translated(make_sphere(0.7, 23, 17), in_cube(random, 1.2F))};
        const ExactMap torus = ExactMap::build(meshes[0]);
        Penetration expected;
        for (std::uint32_t vertex = 0; vertex < meshes[1].vertices.size(); ++vertex) {
            const Contact at = contact(torus, meshes[1].vertices[vertex]);
            expected.vertex_count += at.inside;
            if (!at.inside || at.depth <= expected.depth) continue;
            expected.depth = at.depth;
            expected.deepest_vertex = vertex;
        }
        const std::vector<CheckedMeshes> found = check(meshes);
        const Penetration none, &answer = found.empty() ? none : found.front().b_in_a;
        EXPECT_EQ(answer.vertex_count, expected.vertex_count);
        EXPECT_EQ(answer.depth, expected.depth);
        EXPECT_EQ(answer.deepest_vertex, expected.deepest_vertex);
    }
}

TEST(Check, TellsOfABodyThatIntersectsItselfApart) {
    TriangleMesh crossing = make_box({1, 1, 1});
    const TriangleMesh other = translated(crossing, {0.5F, 0.5F, 0.5F});
    const auto offset = static_cast<std::uint32_t>(crossing.vertices.size());
    for (const Vec3f& v : other.vertices) crossing.vertices.push_back(v);
    for (const Triangle& f : other.faces)
        crossing.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    const std::vector<CheckedMeshes> found =
        check(std::vector{make_sphere(0.1, 9, 5), translated(crossing, {3, 0, 0})});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].a, 1U);
    EXPECT_EQ(found[0].b, 1U);
    EXPECT_FALSE(found[0].a_in_b.known);
}

TEST(Check, TellsOfAMeshThatIsWhollyInsideAnother) {
    const std::vector<CheckedMeshes> found =
        check(std::vector{make_sphere(0.1, 9, 5), make_box({1, 1, 1}, 3)});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].intersect());
    EXPECT_EQ(found[0].a_in_b.vertex_count, make_sphere(0.1, 9, 5).vertices.size());
    EXPECT_GT(found[0].a_in_b.depth, 0.42); // in the direction of a corner of the box
    EXPECT_LE(found[0].a_in_b.depth, 0.5 - 0.1 / std::sqrt(3));
    EXPECT_EQ(found[0].b_in_a.vertex_count, 0U);
    EXPECT_EQ(found[0].b_in_a.deepest_vertex, kNoIndex);
}

TEST(Check, KnowsNoDepthInAnOpenMesh) {
    TriangleMesh open = make_box({1, 1, 1}, 2);
    open.faces.pop_back();
    const std::vector<CheckedMeshes> found = check(std::vector{open, make_sphere(0.6, 30, 15)});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].b_in_a.known);
    EXPECT_TRUE(found[0].a_in_b.known);
    EXPECT_GT(found[0].found.length, 1);
}

TEST(Check, NamesTheMeshThatIsNotValid) {
    const TriangleMesh box = make_box({1, 1, 1});
    TriangleMesh no_vertex = box, not_finite = box, elsewhere = box;
    no_vertex.faces[3][1] = 8;
    not_finite.vertices[2].y = std::numeric_limits<float>::quiet_NaN();
    elsewhere.origin = {1e6, 0, 0};
    expect_error(ErrorCode::InvalidMesh, "mesh 1: face 3", [&] { check(std::vector{box, no_vertex}); });
    expect_error(ErrorCode::InvalidMesh, "mesh 0: face", [&] { check(std::vector{not_finite, box}); });
    expect_error(ErrorCode::InvalidMesh, "mesh 1: the mesh has no faces", [&] {
        check(std::vector{box, {}});
    });
    expect_error(ErrorCode::InvalidMesh, "mesh 1: the origin", [&] { check(std::vector{box, elsewhere}); });
    expect_error(ErrorCode::InvalidMesh, "dress.obj: face 3", [&] {
        check(std::vector{box, no_vertex}, {.names = {"body.obj", "dress.obj"}});
    });
    expect_error(ErrorCode::InvalidOptions, "1 names for 2 meshes", [&] {
        check(std::vector{box, box}, {.names = {"body.obj"}});
    });
    EXPECT_TRUE(check({}).empty());
}

TEST(Check, TakesCopiesMeshesWithoutAreaAndEdgesWithManyFaces) {
    const TriangleMesh box = make_box({1, 1, 1}, 2);
    const std::vector<CheckedMeshes> copies = check(std::vector{box, box});
    ASSERT_EQ(copies.size(), 1U);
    EXPECT_GT(copies[0].found.pairs.size(), 6 * box.faces.size());
    const TriangleMesh point{{{0, 0, 0}}, {{0, 0, 0}}};
    EXPECT_TRUE(check(std::vector{point, box}).front().a_in_b.known);
    TriangleMesh fins = box; // three more faces at an edge
    for (const Vec3f& tip : {Vec3f{2, 0, 0}, Vec3f{2, 1, 0}, Vec3f{2, 2, 0}}) {
        fins.vertices.push_back(tip);
        fins.faces.push_back(
            {box.faces[0][0], box.faces[0][1], static_cast<std::uint32_t>(fins.vertices.size() - 1)});
    }
    EXPECT_FALSE(check(std::vector{fins, box}).empty());
}

TEST(Check, ReportsProgressUpToTheEnd) {
    std::vector<double> shares;
    const TriangleMesh box = make_box({1, 1, 1});
    check(std::vector{box, box, box}, {.progress = [&](double share) { shares.push_back(share); }});
    ASSERT_EQ(shares.size(), 7U);
    EXPECT_EQ(shares.front(), 0);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}
