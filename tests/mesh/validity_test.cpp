#include "support/expect_error.hpp"

#include <echinus/mesh.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>

using namespace echinus;
using namespace echinus::test;

namespace {

void expect_invalid(const TriangleMesh& mesh, const std::string& words) {
    expect_error(ErrorCode::InvalidMesh, words, [&] { require_valid(mesh); });
}

const std::vector<Vec3f> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

} // namespace

TEST(RequireValid, AcceptsASingleFace) {
    EXPECT_NO_THROW(require_valid({kCorners, {{0, 1, 2}}}));
}

TEST(RequireValid, RefusesAMeshWithoutFaces) {
    expect_invalid({}, "no faces");
    expect_invalid({kCorners, {}}, "no faces");
}

TEST(RequireValid, NamesTheFirstFaceWithAnIndexOutOfRange) {
    expect_invalid({kCorners, {{0, 1, 2}, {0, 1, 4}, {9, 9, 9}}}, "face 1 of the mesh refers to vertex 4");
}

TEST(RequireValid, NamesTheFirstFaceWithAPositionThatIsNotFinite) {
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        auto vertices = kCorners;
        vertices[3].y = bad;
        expect_invalid({vertices, {{0, 1, 2}, {0, 1, 3}}}, "face 1 of the mesh uses vertex 3");
        EXPECT_NO_THROW(require_valid({vertices, {{0, 1, 2}}})); // an unused vertex may be anything
    }
}
