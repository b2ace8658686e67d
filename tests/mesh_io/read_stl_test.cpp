#include "mesh_io/encode.hpp"
#include "mesh_io/readers.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

using namespace echinus;
using namespace echinus::test;

namespace {

PolygonMesh read(const std::string& bytes) {
    return read_stl({"a.stl", bytes});
}

void expect_stl_error(ErrorCode code, const std::string& words, const std::string& bytes) {
    expect_error(code, "a.stl: " + words, [&] { read(bytes); });
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";

std::string binary_box() {
    return encode_stl(make_box({1, 1, 1}));
}

} // namespace

TEST(ReadStl, ReadsTextWithSeveralSolids) {
    const PolygonMesh mesh =
        read("solid a b c\n" + kFacet + kFacet + "endsolid a b c\nsolid\n" + kFacet + "endsolid\n");
    EXPECT_EQ(mesh.corner_counts, (std::vector<std::uint32_t>{3, 3, 3}));
    EXPECT_EQ(mesh.vertices.size(), 9U);
    EXPECT_EQ(mesh.vertices[4], (Vec3f{1, 0, 0}));
}

TEST(ReadStl, ReadsBinaryAlsoWhenItBeginsLikeText) {
    std::string bytes = binary_box();
    EXPECT_EQ(read(bytes).corner_counts.size(), 12U);
    bytes.replace(0, 5, "solid");
    EXPECT_EQ(read(bytes).corner_counts.size(), 12U);
}

TEST(ReadStl, NoticesMissingAndSurplusData) {
    const std::string box = binary_box();
    expect_stl_error(ErrorCode::Damaged,
                     "the head of a binary STL promises 12 faces in 684 bytes, but the file has 683",
                     box.substr(0, 683));
    expect_stl_error(ErrorCode::Damaged,
                     "the head of a binary STL promises 12 faces in 684 bytes, but the file has 685",
                     box + "x");
    expect_stl_error(ErrorCode::Damaged, "the file ends where 'facet' or 'endsolid' was expected",
                     "solid a\n" + kFacet);
    expect_stl_error(ErrorCode::Damaged, "the file ends where a vertex was expected",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n");
    expect_stl_error(ErrorCode::Damaged, "line 5: 'vertex' was expected, not 'endloop'",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\n");
    expect_stl_error(ErrorCode::Damaged, "line 2: 'facet' or 'endsolid' was expected, not 'fact'",
                     "solid a\nfact\n");
}

TEST(ReadStl, RefusesCoordinatesThatAreNotFinite) {
    std::string bytes = binary_box();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84 + 3 * 50 + 12, &nan, sizeof(nan));
    expect_stl_error(ErrorCode::InvalidMesh, "face 3 has a coordinate that is not finite", bytes);
    expect_stl_error(ErrorCode::InvalidMesh, "line 4: the coordinate 'inf'",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\n");
}

TEST(ReadStl, IgnoresNormalsThatAreNotFinite) {
    std::string bytes = binary_box();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84, &nan, sizeof(nan));
    EXPECT_EQ(read(bytes).corner_counts.size(), 12U);
}

TEST(ReadStl, RefusesOtherFormats) {
    expect_stl_error(ErrorCode::WrongFormat, "neither 'solid'", "\x89PNG\r\n\x1a\n");
    expect_stl_error(ErrorCode::Damaged, "the head of a binary STL promises", std::string(200, 'x'));
}
