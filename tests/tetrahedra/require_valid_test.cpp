#include "support/expect_error.hpp"
#include "support/tetrahedra.hpp"

#include <gtest/gtest.h>

#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

void expect_invalid(const std::string& words, const TetrahedralMesh& mesh) {
    expect_error(ErrorCode::InvalidMesh, words, [&] { require_valid_tetrahedra(mesh); });
}

} // namespace

TEST(RequireValidTetrahedra, TakesABrickAndWhateverLiesUnusedBesideIt) {
    TetrahedralMesh brick = make_brick(2);
    brick.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
    EXPECT_NO_THROW(require_valid_tetrahedra(brick));
}

TEST(RequireValidTetrahedra, NamesWhatIsWrong) {
    expect_invalid("no tetrahedra", {});
    TetrahedralMesh brick = make_brick(2);
    std::swap(brick.tetrahedra[7][0], brick.tetrahedra[7][1]);
    expect_invalid("tetrahedron 7 has a negative volume", brick);
    brick = make_brick(2);
    brick.vertices[brick.tetrahedra[0][3]].x = std::numeric_limits<float>::infinity();
    expect_invalid("of tetrahedron 0 is not finite", brick);
    brick = make_brick(2);
    brick.tetrahedra[3][0] = brick.tetrahedra[3][1];
    expect_invalid("tetrahedron 3 has vertex", brick);
    brick = make_brick(2);
    brick.tetrahedra[3][0] = 27;
    expect_invalid("tetrahedron 3 refers to vertex 27, but there are 27", brick);
    expect_invalid("tetrahedron 0 is flat",
                   {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1F, 0.1F, 0}}, {{0, 1, 2, 3}}});
    brick = make_brick(1);
    brick.tetrahedra.push_back(brick.tetrahedra[5]);
    expect_invalid("tetrahedra 5 and 6 lie on the same side", brick);
}

TEST(RequireValidTetrahedra, FindsFlatnessThatRoundingHides) {
    // Doubles of floats: the last corner lies off the plane by one unit in the last place of a large number.
    const float far = 16777216;
    TetrahedralMesh mesh{{{far, 0, 0}, {0, far, 0}, {0, 0, far}, {far, far, -far}}, {{0, 1, 2, 3}}};
    expect_invalid("tetrahedron 0 is flat", mesh);
    mesh.vertices[3].x = far - 1;
    EXPECT_ANY_THROW(require_valid_tetrahedra(mesh));
    std::swap(mesh.tetrahedra[0][0], mesh.tetrahedra[0][1]);
    EXPECT_NO_THROW(require_valid_tetrahedra(mesh));
}
