#include "rivals/embree_tree/embree_tree.hpp"
#include "support/meshes.hpp"
#include "support/point_sets.hpp"
#include "support/random_points.hpp"

#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

using namespace echinus;
using rivals::EmbreeTree;
using rivals::RaySides;

namespace {

constexpr RaySides kBoth[] = {RaySides::Parity, RaySides::FirstHit};

/// The lattice that ExactMap snaps to moves a surface by up to a step, 1.9e-6 of the radius; single precision
/// rounds as much once more.
constexpr float kRounding = 1e-5F;

std::vector<TriangleMesh> meshes() {
    return {make_torus(0.7, 0.3, 24, 12), make_box({1, 2, 0.3}, 2), make_sphere(1, 16, 8)};
}

/// How many of the points are not on the exact map's side.
std::size_t wrong_sides(const TriangleMesh& mesh, const std::vector<Vec3f>& points, RaySides sides) {
    std::vector<std::uint8_t> truth(points.size()), answers(points.size());
    const ExactMap judge = ExactMap::build(mesh);
    contains_batch(judge, points, truth);
    EmbreeTree::build(mesh, sides).contains_batch(points, answers);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) wrong += truth[i] != answers[i];
    return wrong;
}

} // namespace

TEST(EmbreeTree, FindsTheNearestPointThatTheExactMapFinds) {
    for (const TriangleMesh& mesh : meshes()) {
        const ExactMap exact = ExactMap::build(mesh);
        const EmbreeTree tree = EmbreeTree::build(mesh);
        test::Random random(8);
        for (int i = 0; i < 1000; ++i) {
            const Vec3f p = test::in_cube(random, 1.2F);
            const auto [point, distance, face] = tree.nearest(p);
            ASSERT_NEAR(distance, std::abs(contact(exact, p, 10).depth), kRounding);
            ASSERT_NEAR(length(point - p), distance, kRounding);
            ASSERT_NEAR(contact(exact, point, 10).depth, 0, kRounding) << "is not on the surface";
            ASSERT_LT(static_cast<std::size_t>(face), mesh.faces.size());
        }
    }
}

TEST(EmbreeTree, TakesAnOpenMeshOnlyByItsOwnFunction) {
    const TriangleMesh face{{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}, {{0, 1, 2}}}; // seen from behind from below
    EXPECT_THROW((void)EmbreeTree::build(face), Error);
    const EmbreeTree tree = EmbreeTree::build_open(face, RaySides::FirstHit);
    EXPECT_TRUE(tree.contains({0, 0, -0.1F}));
    EXPECT_FALSE(tree.contains({0, 0, 0.1F}));
    EXPECT_FLOAT_EQ(tree.nearest({0, 0, 2}).distance, 2);
    EXPECT_THROW((void)EmbreeTree::build_open({}), Error);
}

TEST(EmbreeTree, FindsTheNearestPointOfABoxByItsFormula) {
    const EmbreeTree tree = EmbreeTree::build(make_box({2, 2, 2}, 3));
    const auto expect_nearest = [&](const Vec3f& from, const Vec3f& to) {
        const auto [point, distance, face] = tree.nearest(from);
        EXPECT_LT(length(point - to), 1e-6F);
        EXPECT_NEAR(distance, length(to - from), 1e-6);
    };
    expect_nearest({0.75F, 0.25F, -0.5F}, {1, 0.25F, -0.5F}); // a face
    expect_nearest({3, 0.25F, 3}, {1, 0.25F, 1});             // an edge
    expect_nearest({3, 3, -3}, {1, 1, -1});                   // a corner
}

TEST(EmbreeTree, TellsTheSidesThatTheExactMapTellsButForFewAtEdges) {
    for (const TriangleMesh& mesh : meshes())
        for (const RaySides sides : kBoth) {
            EXPECT_LE(wrong_sides(mesh, test::uniform_points(mesh, 5000), sides), 1);
            EXPECT_LE(wrong_sides(mesh, test::surface_points(mesh, 5000), sides), 3);
        }
}

/// Long faces across many boxes are what spatial splits are made for, and may then be reported twice.
TEST(EmbreeTree, CountsLongFacesOnce) {
    TriangleMesh needles;
    for (int i = 0; i < 40; ++i) {
        TriangleMesh needle = make_box({4, 0.02, 0.02});
        const Rotation turn = Rotation::about({1, 0.3 * i, 0.7}, 0.4 * i);
        for (Vec3f& v : needle.vertices) v = Vec3f(turn.apply(Vec3d(v)));
        needles = test::joined({needles, test::translated(needle, {0, 0, 0.1F * static_cast<float>(i)})});
    }
    std::vector<Vec3f> points; // outside all of them, whose overlaps parity tells differently
    std::vector<std::uint8_t> inside;
    const ExactMap exact = ExactMap::build(needles);
    for (const Vec3f& p : test::uniform_points(needles, 5000))
        if (!contains(exact, p)) points.push_back(p);
    inside.resize(points.size());
    EmbreeTree::build(needles).contains_batch(points, inside);
    EXPECT_LE(std::count(inside.begin(), inside.end(), 1), 1);
}

TEST(EmbreeTree, CountsACavityAsOutside) {
    const TriangleMesh shell =
        test::joined({make_sphere(1, 24, 12), test::turned_inside_out(make_sphere(0.5, 24, 12))});
    for (const RaySides sides : kBoth) {
        const EmbreeTree tree = EmbreeTree::build(shell, sides);
        EXPECT_FALSE(tree.contains({0.1F, 0.05F, 0.02F}));
        EXPECT_TRUE(tree.contains({0.7F, 0.05F, 0.02F}));
        EXPECT_FALSE(tree.contains({1.2F, 0.05F, 0.02F}));
    }
}

TEST(EmbreeTree, AnswersTheSameOneByOneAndInPackets) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 24, 12);
    std::vector<Vec3f> points = test::uniform_points(mesh, 1003);
    points.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    for (const RaySides sides : kBoth) {
        const EmbreeTree tree = EmbreeTree::build(mesh, sides);
        std::vector<std::uint8_t> packets(points.size(), 2), single(points.size(), 3);
        tree.contains_batch(points, packets);
        tree.contains_one_by_one(points, single);
        EXPECT_EQ(packets, single);
    }
}

TEST(EmbreeTree, SeesWhichWaysAreCrossed) {
    const EmbreeTree tree = EmbreeTree::build(make_box({2, 2, 2}));
    EXPECT_TRUE(tree.crossed({0, 0.1F, 0.2F}, {2, 0.1F, 0.2F}));
    EXPECT_FALSE(tree.crossed({0, 0.1F, 0.2F}, {0.9F, 0.1F, 0.2F}));
    EXPECT_FALSE(tree.crossed({2, 0.1F, 0.2F}, {3, 0.1F, 0.2F}));
}

TEST(EmbreeTree, CountsTheMeshAndMore) {
    const TriangleMesh mesh = make_torus(0.7, 0.3, 60, 24);
    const std::size_t of_mesh = mesh.vertices.size() * sizeof(Vec3f) + mesh.faces.size() * sizeof(Triangle);
    EXPECT_GT(EmbreeTree::build(mesh).byte_count(), of_mesh);
    EXPECT_LT(EmbreeTree::build(mesh).byte_count(), 20 * of_mesh);
}

TEST(EmbreeTree, DoesNotNeedTheMeshAfterwards) {
    auto mesh = std::make_unique<TriangleMesh>(make_box({2, 2, 2}));
    const EmbreeTree tree = EmbreeTree::build(*mesh);
    mesh->vertices.assign(mesh->vertices.size(), {});
    mesh.reset();
    EXPECT_NEAR(tree.nearest({0.75F, 0.25F, -0.5F}).distance, 0.25, 1e-6);
}
