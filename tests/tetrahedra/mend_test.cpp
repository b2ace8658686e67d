#include "support/tetrahedra.hpp"
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
