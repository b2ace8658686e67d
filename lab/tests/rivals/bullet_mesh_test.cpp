#include "rivals/bullet_mesh/bullet_mesh.hpp"
#include "support/expectations.hpp"
#include "support/point_sets.hpp"

#include <echinus/exact_map.hpp>

#include <gtest/gtest.h>

#include <vector>

using namespace echinus;
using rivals::BulletMesh;

TEST(BulletMesh, TellsNearlyAllSidesThatTheExactMapTells) {
    for (const TriangleMesh& mesh : {make_torus(0.7, 0.3, 24, 12), make_box({1, 2, 0.3}, 2)}) {
        const std::vector<Vec3f> points = test::uniform_points(mesh, 5000);
        std::vector<std::uint8_t> truth(points.size()), answers(points.size(), 2);
        const ExactMap judge = ExactMap::build(mesh);
        contains_batch(judge, points, truth);
        BulletMesh::build(mesh).contains_batch(points, answers);
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i) wrong += truth[i] != answers[i];
        EXPECT_LE(wrong, 5);
    }
}

TEST(BulletMesh, FindsTheWayOutOnlyWithinItsReach) {
    const BulletMesh mesh = BulletMesh::build(make_box({2, 2, 2}, 4), 0.1); // 0.1 sqrt(3)
    const std::vector<Vec3f> points{{0.95F, 0.1F, 0.2F}, {0.1F, -0.9F, 0.2F}, {0.5F, 0.1F, 0.2F}};
    std::vector<Contact> contacts(points.size());
    mesh.contacts_batch(points, contacts);
    EXPECT_NEAR(contacts[0].depth, 0.05, 1e-4);
    EXPECT_LT(length(contacts[0].point - Vec3f{1, 0.1F, 0.2F}), 1e-4F);
    EXPECT_LT(length(contacts[0].normal - Vec3f{1, 0, 0}), 1e-2F);
    EXPECT_NEAR(contacts[1].depth, 0.1, 1e-4);
    EXPECT_LT(length(contacts[1].normal - Vec3f{0, -1, 0}), 1e-2F);
    EXPECT_TRUE(contacts[2].inside);
    EXPECT_EQ(contacts[2].depth, 0);
    EXPECT_EQ(contacts[2].normal, Vec3f{});
    EXPECT_EQ(contacts[2].point, points[2]);
}

TEST(BulletMesh, FindsTheDepthThatTheExactMapFindsWithALongReach) {
    const TriangleMesh torus = make_torus(0.7, 0.3, 24, 12);
    const ExactMap exact = ExactMap::build(torus);
    const std::vector<Vec3f> points = test::uniform_points(torus, 500);
    std::vector<Contact> contacts(points.size());
    BulletMesh::build(torus, 1).contacts_batch(points, contacts);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!contacts[i].inside || !contains(exact, points[i])) continue;
        ++inside;
        ASSERT_NEAR(contacts[i].depth, contact(exact, points[i]).depth, 1e-4) << i;
    }
    EXPECT_GT(inside, 50);
}

TEST(BulletMesh, RefusesAReachThatIsNone) {
    for (const double reach : {0.0, -1.0, 3.0, std::numeric_limits<double>::quiet_NaN()})
        test::expect_error(ErrorCode::InvalidOptions, "reach", [&] {
            BulletMesh::build(make_box({1, 1, 1}), reach);
        });
}
