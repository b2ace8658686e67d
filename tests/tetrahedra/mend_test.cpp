#include "support/soft_bodies.hpp"
#include "tetrahedra/mend.hpp"

#include <gtest/gtest.h>

#include <algorithm>

using namespace echinus;
using namespace echinus::test;

TEST(MendTetrahedra, TurnsNegativeOnesOnly) {
    TetrahedralMesh body = make_brick(2);
    std::swap(body.tetrahedra[3][0], body.tetrahedra[3][2]);
    std::swap(body.tetrahedra[8][1], body.tetrahedra[8][3]);
    EXPECT_ANY_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(turn_negative(body), 2U);
    EXPECT_NO_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(turn_negative(body), 0U);
    EXPECT_EQ(body.tetrahedra[0], make_brick(2).tetrahedra[0]);
}

TEST(MendTetrahedra, DropsVerticesThatNothingUses) {
    TetrahedralMesh body = make_brick(2);
    std::erase_if(body.tetrahedra, [&](const Tetrahedron& corners) { // all that reach beyond x = 1
        return std::any_of(corners.begin(), corners.end(), [&](auto v) { return body.vertices[v].x > 1; });
    });
    const MeshReport before = inspect(boundary(body));
    EXPECT_EQ(drop_unused_vertices(body), 9U);
    EXPECT_EQ(body.vertices.size(), 18U);
    EXPECT_NO_THROW(require_valid_tetrahedra(body));
    EXPECT_EQ(inspect(boundary(body)).signed_volume, before.signed_volume);
    EXPECT_EQ(before.signed_volume, 4);
}

namespace {

bool is_manifold(const TetrahedralMesh& mesh) {
    return inspect(boundary(mesh)).manifold;
}

/// The brick without the cubes for which `is_gone` holds.
template <typename IsGone>
TetrahedralMesh brick_without(std::uint32_t count, IsGone&& is_gone) {
    TetrahedralMesh brick = make_brick(count), left{brick.vertices, {}};
    for (std::uint32_t number = 0; number < brick.tetrahedra.size(); ++number) {
        const std::uint32_t cube = number / 6;
        if (!is_gone(cube % count, cube / count % count, cube / count / count))
            left.tetrahedra.push_back(brick.tetrahedra[number]);
    }
    return left;
}

} // namespace

TEST(RemovePinches, LeavesAManifoldBodyAlone) {
    TetrahedralMesh brick = make_brick(3);
    EXPECT_EQ(remove_pinches(brick), 0U);
    EXPECT_EQ(brick.tetrahedra, make_brick(3).tetrahedra);
}

TEST(RemovePinches, PartsCubesThatMeetInAnEdge) {
    TetrahedralMesh body = brick_without(2, [](auto x, auto y, auto) { return x != y; });
    ASSERT_FALSE(is_manifold(body));
    const std::size_t before = body.tetrahedra.size();
    const std::size_t removed = remove_pinches(body);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_EQ(body.tetrahedra.size(), before - removed);
    EXPECT_GE(body.tetrahedra.size(), before / 2); // the larger part stays whole
}

TEST(RemovePinches, PartsCubesThatMeetInACorner) {
    TetrahedralMesh body = brick_without(2, [](auto x, auto y, auto z) { return x != y || y != z; });
    ASSERT_FALSE(is_manifold(body));
    EXPECT_GT(remove_pinches(body), 0U);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_GE(body.tetrahedra.size(), 6U);
}

TEST(RemovePinches, OpensHollowsThatMeetInACorner) {
    TetrahedralMesh body = brick_without(4, [](auto x, auto y, auto z) {
        return (x == 1 && y == 1 && z == 1) || (x == 2 && y == 2 && z == 2);
    });
    ASSERT_FALSE(is_manifold(body));
    EXPECT_GT(remove_pinches(body), 0U);
    EXPECT_TRUE(is_manifold(body));
    EXPECT_GT(body.tetrahedra.size(), 62U * 6 - 40);
}
