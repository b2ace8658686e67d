#include "mesh_io/readers.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

namespace {

using Indices = std::vector<std::uint32_t>;

PolygonMesh read_off_text(const std::string& text) {
    return read_off({"a.off", text});
}

const std::string kVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

void expect_off_error(ErrorCode code, const std::string& words, const std::string& text) {
    expect_error(code, "a.off: " + words, [&] { read_off_text(text); });
}

} // namespace

TEST(ReadOff, ReadsPolygonsWithAndWithoutColours) {
    const PolygonMesh mesh = read_off_text("OFF\n# a comment\n4 3 0\n" + kVertices +
                                           "3 0 1 2\n4 0 1 2 3 255 0 0\n\n3 0 2 3 0.5 0.5 0.5 1\n");
    EXPECT_EQ(mesh.vertices.size(), 4U);
    EXPECT_EQ(mesh.corner_counts, (Indices{3, 4, 3}));
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 0, 1, 2, 3, 0, 2, 3}));
}

TEST(ReadOff, ReadsTheNumbersOnTheLineOfTheKeywordAndWithoutTheLastOne) {
    EXPECT_EQ(read_off_text("OFF 4 1\n" + kVertices + "3 0 1 2").corners, (Indices{0, 1, 2}));
}

TEST(ReadOff, ReadsEverySpellingOfTheHead) {
    for (const char* head :
         {"OFF\n4 1 0\n", "OFF4 1 0\n", "OFF4 1\n", "4 1 0\n", "4 1\n", "4\n1\n0\n", "OFF\n4\n1\n0\n",
          "OFF 4\n1 0\n", "OFF\n4 1\n0\n", "  OFF # a\n\n# b\n4 # c\n 1 0\n", "off\n4 1 0\n",
          "\xef\xbb\xbfOFF\r\n4 1 0\r\n", "nOFF\n3\n4 1 0\n", "nOFF 3 4 1 0\n"}) {
        EXPECT_EQ(read_off_text(head + kVertices + "3 0 1 2\n").corners, (Indices{0, 1, 2})) << head;
        EXPECT_EQ(read_off_text(head + std::string("0 0 0 1 0 0\n1 1 0 0\n1 0 3 0\n1 2\n")).corners,
                  (Indices{0, 1, 2}))
            << head;
    }
}

TEST(ReadOff, ReadsNumbersAcrossLinesWhereTheLinesAreNotAsManyAsVerticesAndFaces) {
    const PolygonMesh mesh =
        read_off_text("OFF 4 2 0\n0 0\n0 1 0 0 1\n1 0\n0 1 0\n4 0 1\n2\n3 255 0 0\n3\n0 2 3\n");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 3, 0, 2, 3}));
    EXPECT_EQ(mesh.corner_counts, (Indices{4, 3}));
    expect_off_error(ErrorCode::Damaged,
                     "line 3: a coordinate was expected, not 'x', where numbers are read across "
                     "lines, as 3 lines follow the header, but it declares 5 vertices and faces",
                     "OFF\n4 1 0\n0 0 0 1 0 x\n1 1 0 0 1 0\n3 0 1 2\n");
}

TEST(ReadOff, DividesByTheFourthCoordinate) {
    for (const char* lines :
         {"0 0 0 1\n2 0 0 2\n0 -3 0 -3\n3 0 1 2\n", "0 0 0\n1 2 0\n0 2 0\n-3 0\n-3 3 0\n1 2\n"})
        EXPECT_EQ(read_off_text(std::string("4OFF\n3 1 0\n") + lines).vertices,
                  (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    expect_off_error(ErrorCode::InvalidMesh, "line 2: the vertex is not finite", "4OFF 1 0 0\n1 0 0 0\n");
    expect_off_error(ErrorCode::InvalidMesh, "line 2: the vertex is not finite", "4OFF 1 0 0\n0 0 0 0\n");
}

TEST(ReadOff, PassesOverWhatItsKeywordNamesAlsoAcrossLines) {
    const std::string extras[] = {" 0 0 1", " 1 1 1 1", " 0.5 0.5", " 0 0 1 1 1 1 1 0.5 0.5"};
    const std::string keywords[] = {"NOFF", "COFF", "STOFF", "STCNOFF"};
    for (int i = 0; i < 4; ++i) {
        const std::string &more = extras[i], first = "0 0 0" + more, second = "1 0 0" + more,
                          third = "0 1 0" + more;
        for (const std::string& lines :
             {first + "\n" + second + "\n" + third, first + " " + second + "\n" + third})
            EXPECT_EQ(read_off_text(keywords[i] + "\n3 1 0\n" + lines + "\n3 0 1 2 9\n").vertices,
                      (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}))
                << lines;
    }
}

TEST(ReadOff, PassesOverColoursAndNormalsOfVertices) {
    const PolygonMesh mesh = read_off_text(
        "CNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 255 0 0 255\n0 1 0 0 0 1 0 0 0 0\n3 0 1 2\n");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadOff, NoticesMissingAndSurplusLines) {
    expect_off_error(ErrorCode::Damaged, "the file ends where vertex 4 of 4 was expected",
                     "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n");
    expect_off_error(ErrorCode::Damaged, "the file ends where face 2 of 2 was expected",
                     "OFF\n4 2 0\n" + kVertices + "3 0 1 2\n");
    expect_off_error(ErrorCode::Damaged, "the file ends where the number of vertices was expected", "OFF\n");
    expect_off_error(ErrorCode::Damaged, "line 8: the file continues after the 1 faces",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1 2\n3 0 2 3\n");
    expect_off_error(ErrorCode::Damaged, "line 7: a vertex number was expected, not the end of the line",
                     "OFF\n4 1 0\n" + kVertices + "3 0 1\n");
    expect_off_error(ErrorCode::Damaged, "line 4: a coordinate was expected",
                     "OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n");
}

TEST(ReadOff, DoesNotBelieveImpossibleNumbers) {
    expect_off_error(ErrorCode::Damaged, "line 2: the number of vertices cannot be -4", "OFF\n-4 1 0\n");
    expect_off_error(ErrorCode::Damaged, "line 2: the number of vertices cannot be 99999999999",
                     "OFF\n99999999999 1 0\n");
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
    expect_off_error(ErrorCode::WrongFormat, "line 1: OFF, COFF, NOFF or the like was expected, not 'OFFx'",
                     "OFFx\n1 1 1\n");
    for (const std::string dimension : {"2", "4"})
        expect_off_error(ErrorCode::WrongFormat,
                         "line 2: vertices have " + dimension + " coordinates; only those of three",
                         "nOFF\n" + dimension + "\n1 1 1\n");
    expect_off_error(ErrorCode::WrongFormat, "line 1: vertices have 3 + 1 coordinates", "4nOFF 3\n1 1 1\n");
    for (const char* keyword : {"OFF BINARY\n", "COFF binary\n"})
        expect_off_error(ErrorCode::WrongFormat, "line 1: binary OFF is not read; save the mesh as text",
                         keyword + std::string("\0\0\0\4\0\0\0\1", 8));
    expect_off_error(ErrorCode::Damaged, "line 2: the number of edges was expected, not 'x'",
                     "OFF\n4 1 x\n" + kVertices);
}
