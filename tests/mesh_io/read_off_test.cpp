#include "mesh_io/readers.hpp"
#include "support/expect_error.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

namespace {

using Indices = std::vector<std::uint32_t>;

PolygonMesh read(const std::string& text) {
    return read_off({"a.off", text});
}

const std::string kVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

void expect_off_error(ErrorCode code, const std::string& words, const std::string& text) {
    expect_error(code, "a.off: " + words, [&] { read(text); });
}

} // namespace

TEST(ReadOff, ReadsPolygonsWithAndWithoutColours) {
    const PolygonMesh mesh = read("OFF\n# a comment\n4 3 0\n" + kVertices +
                                  "3 0 1 2\n4 0 1 2 3 255 0 0\n\n3 0 2 3 0.5 0.5 0.5 1\n");
    EXPECT_EQ(mesh.vertices.size(), 4U);
    EXPECT_EQ(mesh.corner_counts, (Indices{3, 4, 3}));
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 0, 1, 2, 3, 0, 2, 3}));
}

TEST(ReadOff, ReadsTheNumbersOnTheLineOfTheKeywordAndWithoutTheLastOne) {
    EXPECT_EQ(read("OFF 4 1\n" + kVertices + "3 0 1 2").corners, (Indices{0, 1, 2}));
}

TEST(ReadOff, PassesOverColoursAndNormalsOfVertices) {
    const PolygonMesh mesh = read(
        "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 255 0 0 255\n0 1 0 0 0 1 0 0 0 0\n3 0 1 2\n");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadOff, NoticesMissingAndSurplusLines) {
    expect_off_error(ErrorCode::Damaged, "the file ends where vertex 4 of 4 was expected",
                     "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n");
    expect_off_error(ErrorCode::Damaged, "the file ends where face 2 of 2 was expected",
                     "OFF\n4 2 0\n" + kVertices + "3 0 1 2\n");
    expect_off_error(ErrorCode::Damaged, "the file ends where the number of vertices was expected", "OFF\n");
    expect_off_error(ErrorCode::Damaged, "line 8: the file goes on after the 1 faces",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1 2\n3 0 2 3\n");
    expect_off_error(ErrorCode::Damaged, "line 7: a vertex number was expected, not the end of the line",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1\n");
    expect_off_error(ErrorCode::Damaged, "line 4: a coordinate was expected",
                     "OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n");
}

TEST(ReadOff, DoesNotBelieveImpossibleNumbers) {
    expect_off_error(ErrorCode::Damaged, "line 2: there cannot be -4", "OFF\n-4 1 0\n");
    expect_off_error(ErrorCode::Damaged, "line 2: there cannot be 99999999999", "OFF\n99999999999 1 0\n");
    expect_off_error(ErrorCode::Damaged, "the file ends where vertex 5 of 4000000000",
                     "OFF\n4000000000 4000000000 0\n" + kVertices);
    expect_off_error(ErrorCode::Damaged, "line 7: a vertex number",
                     "OFF\n4 1 0\n" + kVertices + "4000000000 0 1 2\n");
}

TEST(ReadOff, NamesTheLineOfAnIndexOutOfRange) {
    expect_off_error(ErrorCode::InvalidMesh, "line 7: the face refers to vertex 4, but there are 4",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1 4\n");
    expect_off_error(ErrorCode::InvalidMesh, "line 7: the face refers to vertex -1",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1 -1\n");
}

TEST(ReadOff, RefusesOtherFormats) {
    expect_off_error(ErrorCode::WrongFormat, "line 1: OFF, COFF, NOFF or the like was expected, not 'ply'",
                     "ply\n");
    expect_off_error(ErrorCode::WrongFormat, "line 1: OFF, COFF, NOFF or the like was expected, not '4OFF'",
                     "4OFF\n1 1 1\n");
    expect_off_error(ErrorCode::Damaged, "line 1: the number of vertices was expected, not 'BINARY'",
                     "OFF BINARY\n");
}
