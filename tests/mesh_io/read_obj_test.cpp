#include "mesh_io/readers.hpp"
#include "support/expectations.hpp"

#include <gtest/gtest.h>

using namespace echinus;
using namespace echinus::test;

namespace {

using Indices = std::vector<std::uint32_t>;

PolygonMesh read(const std::string& text) {
    return read_obj({"a.obj", text});
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

void expect_obj_error(ErrorCode code, const std::string& words, const std::string& text) {
    expect_error(code, "a.obj: " + words, [&] { read(text); });
}

} // namespace

TEST(ReadObj, ReadsEverySpellingOfACorner) {
    for (const char* face :
         {"f 1 2 3 4", "f 1/7 2/8 3/9 4/9", "f 1//7 2//8 3//9 4//9", "f 1/1/7 2/2/8 3/3/9 4/4/9",
          "f -4 -3 -2 -1", "f -4//-1 -3//-1 -2//-1 -1//-1", "f 1/ 2/ 3/ 4/", "f 1// 2// 3// 4//",
          "fo 1 2 3 4", "f 1 2 \\\n3\\\r\n 4", "f\t+1\f2\v3 4 # 5", "f 1 2 3 4#5"}) {
        const PolygonMesh mesh = read(kSquare + face);
        EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 3})) << face;
        EXPECT_EQ(mesh.corner_counts, (Indices{4})) << face;
    }
}

TEST(ReadObj, PassesOverEverythingButVerticesFacesAndLines) {
    const PolygonMesh mesh =
        read("# made by hand\nmtllib a.mtl\no thing\ng part\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nvt 0 0\n"
             "vn 0 0 1\nv 1 1 0\nusemtl red\ns off\np 1\nf 1 2 3\n");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}));
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2}));
}

TEST(ReadObj, CutsALineIntoPolygonsOfTwoCorners) {
    const PolygonMesh mesh = read(kSquare + "f 1 2 3\nl 1/4 2/5 -1\nl 3\n");
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 0, 1, 1, 3}));
    EXPECT_EQ(mesh.corner_counts, (Indices{3, 2, 2}));
}

TEST(ReadObj, CountsNegativeNumbersFromTheVerticesSoFar) {
    EXPECT_EQ(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 9 9 9\nf -1 -2 -3\n").corners,
              (Indices{0, 1, 2, 3, 2, 1}));
}

TEST(ReadObj, ReadsTextsOfDosOfMacsAndWithAMark) {
    const std::string text = kSquare + "f 1 2 3\n";
    for (const std::string end : {"\r\n", "\r", "\n\n", "\f\n", " \t\r\n"}) {
        std::string other = "\xef\xbb\xbf";
        for (const char c : text) other += c == '\n' ? end : std::string(1, c);
        EXPECT_EQ(read(other + "\x1a" + std::string(100, '\0')).corners, (Indices{0, 1, 2})) << end;
    }
}

TEST(ReadObj, KeepsTheStatementAfterACommentThatEndsWithABackslash) {
    const PolygonMesh mesh = read("# C:\\meshes\\\n" + kSquare + "f 1 2 3 # \\\nf 1 3 4\n");
    EXPECT_EQ(mesh.vertices.size(), 4U);
    EXPECT_EQ(mesh.corners, (Indices{0, 1, 2, 0, 2, 3}));
}

TEST(ReadObj, PassesOverPathsWithBackslashesButNotOverTheNextStatement) {
    EXPECT_EQ(read("mtllib C:\\a\\b.mtl\nusemtl x\\y\ng a \\\n b\ncurv2 1 2 \\\n 3\n" + kSquare + "f 1 2 3\n")
                  .corners,
              (Indices{0, 1, 2}));
    expect_obj_error(ErrorCode::Damaged,
                     "line 1: 'usemtl' continues on the next line, as the backslash at its end says, but "
                     "there 'v' follows; remove the backslash",
                     "usemtl C:\\mats\\\n" + kSquare);
    expect_obj_error(ErrorCode::Damaged, "line 5: 'g' continues", kSquare + "g a\\\nf 1 2 3\n");
    expect_obj_error(ErrorCode::Damaged, "line 1: 'v' continues", "v 0 0 0\\\n" + kSquare);
    expect_obj_error(ErrorCode::Damaged, "line 5: a vertex number was expected, not 'f'",
                     kSquare + "f 1 2 3 \\\nf 1 3 4\n");
}

TEST(ReadObj, RefusesToLeaveOutWhatAnotherFileHas) {
    expect_obj_error(ErrorCode::WrongFormat, "line 5: 'call' includes statements from another file",
                     kSquare + "call b.obj\n");
}

TEST(ReadObj, ReadsAFaceOfVeryManyLines) {
    std::string text, face = "f";
    for (int i = 0; i < 3000; ++i) {
        text += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
        face += " " + std::to_string(i + 1) + (i % 2 ? "\\\n" : " ");
    }
    EXPECT_EQ(read(text + face + "\n").corner_counts, (Indices{3000}));
}

TEST(ReadObj, LetsAFacePrecedeItsVertices) {
    EXPECT_EQ(read("f 1 2 3\n" + kSquare).corners, (Indices{0, 1, 2}));
}

TEST(ReadObj, NamesTheLineOfAnIndexOutOfRange) {
    expect_obj_error(ErrorCode::InvalidMesh, "line 5: there is no vertex 0; they are numbered from 1",
                     kSquare + "f 0 1 2\n");
    expect_obj_error(ErrorCode::InvalidMesh,
                     "line 5: there is no vertex -5; -1 is the latest of the 4 before",
                     kSquare + "f -5 1 2\n");
    expect_obj_error(ErrorCode::InvalidMesh,
                     "line 6: the statement refers to vertex 7, but the file has only 4",
                     kSquare + "f 1 2 3\nf 1 2 7\nf 1 2 3\n");
    expect_obj_error(ErrorCode::InvalidMesh, "line 5: there is no vertex 4294967297",
                     kSquare + "f 1 2 4294967297\n");
    expect_obj_error(ErrorCode::Damaged, "line 5: a vertex number", kSquare + "f 1 2 99999999999999999999\n");
}

TEST(ReadObj, NamesTheLineOfANumberThatIsNone) {
    expect_obj_error(ErrorCode::Damaged, "line 1: a coordinate was expected, not the end of the line",
                     "v 0 0\n");
    expect_obj_error(ErrorCode::Damaged, "line 1: a coordinate was expected, not 'zero'", "v 0 0 zero\n");
    expect_obj_error(ErrorCode::Damaged, "line 1: a coordinate was expected, not '0x10'", "v 0 0 0x10\n");
    expect_obj_error(ErrorCode::InvalidMesh, "line 2: the coordinate '1.#QNAN' is not finite",
                     "v 0 0 0\nv 0 0 1.#QNAN\n");
    expect_obj_error(ErrorCode::InvalidMesh, "line 2: the coordinate '1e39' is not finite as a float",
                     "v 0 0 0\nv 0 0 1e39\n");
    expect_obj_error(ErrorCode::InvalidMesh, "line 2: the coordinate 'nan' is not finite",
                     "v 0 0 0\nv nan 0 0\n");
    expect_obj_error(ErrorCode::InvalidMesh, "line 1: the coordinate '-inf' is not finite", "v 0 -inf 0\n");
    expect_obj_error(ErrorCode::Damaged, "line 5: a vertex number was expected, not 'x'",
                     kSquare + "f 1 2 x\n");
    expect_obj_error(ErrorCode::Damaged, "line 5: a vertex number was expected, not '//1'",
                     kSquare + "f 1 2 //1\n");
}

TEST(ReadObj, NamesTheLineOfAFaceWithTooFewVertices) {
    expect_obj_error(ErrorCode::WrongFormat, "line 6: a face needs at least 3 vertices, not 2",
                     kSquare + "f 1 2 3\nf 1 2"); // as in a file that was cut off
    expect_obj_error(ErrorCode::WrongFormat, "line 5: a face needs at least 3 vertices, not 0",
                     kSquare + "f\nf 1 2 3\n");
}

TEST(ReadObj, RefusesAFileOfAnotherKind) {
    expect_obj_error(ErrorCode::WrongFormat, "line 1: '?PNG' is not a statement", "\x89PNG\r\n\x1a\n");
    expect_obj_error(ErrorCode::WrongFormat, "line 1: '{\"asset\":' is not a statement", "{\"asset\": {}}");
    expect_obj_error(ErrorCode::WrongFormat, "line 1: 'OFF' is not a statement", "OFF\n4 4 0\n");
}
