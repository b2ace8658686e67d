#include "mesh_io/write_mesh.hpp"
#include "support/attacks.hpp"
#include "support/expectations.hpp"
#include "support/soft_bodies.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

/// The files that the fuzzer starts from: the same two tetrahedra in every format.
std::vector<fs::path> samples() {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(ECHINUS_TETRAHEDRA)) paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

class ReadTetrahedra : public TemporaryFolderTest {
  protected:
    fs::path write(const std::string& name, const std::string& content) const {
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }
    void expect_refused(const std::string& name, const std::string& content, ErrorCode code,
                        const std::string& words) const {
        const fs::path file = write(name, content);
        expect_error(code, words, [&] { read_tetrahedra(file); });
        expect_error(code, file.string() + ": ", [&] { read_tetrahedra(file); });
    }
    std::string sample(const std::string& name) const {
        return content_of(fs::path(ECHINUS_TETRAHEDRA) / name);
    }
};

} // namespace

TEST_F(ReadTetrahedra, GivesTheSameBodyFromEveryFormat) {
    const std::vector<Vec3f> vertices{{0, 0, 0}, {1.5F, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1.25F}};
    const std::vector<fs::path> paths = samples();
    EXPECT_EQ(paths.size(), 10U);
    for (const fs::path& path : paths) {
        SCOPED_TRACE(path);
        const TetrahedraFile file = read_any_tetrahedra(content_of(path));
        EXPECT_EQ(file.mesh.vertices, vertices);
        EXPECT_EQ(file.mesh.tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
        EXPECT_EQ(file.turned_tetrahedra, 0U);
        EXPECT_EQ(file.dropped_vertices, 0U);
    }
}

TEST_F(ReadTetrahedra, ReadsBackWhatIsWritten) {
    TetrahedralMesh brick = make_brick(3);
    std::mt19937 random(1);
    for (Vec3f& vertex : brick.vertices)
        vertex += Vec3f{1e-4F * static_cast<float>(random() % 1000), 1.0F / 3, -1.0F / 7};
    for (const char* name : {"body.msh", "body.vtk", "BODY.MSH"}) {
        write_tetrahedra(path(name), brick);
        const TetrahedraFile file = read_tetrahedra(path(name));
        EXPECT_EQ(file.mesh.vertices, brick.vertices);
        EXPECT_EQ(file.mesh.tetrahedra, brick.tetrahedra);
    }
}

TEST_F(ReadTetrahedra, FindsTheOtherFileOfTetGensPair) {
    for (const char* name : {"from_0.tetgen", "from_1.tetgen"}) {
        const std::string both = sample(name);
        const std::size_t middle = both.find('\0');
        write("body.node", both.substr(0, middle));
        write("body.ele", both.substr(middle + 1));
        EXPECT_EQ(read_tetrahedra(path("body.node")).mesh.tetrahedra.size(), 2U);
        EXPECT_EQ(read_tetrahedra(path("body.ele")).mesh.vertices.size(), 5U);
    }
    fs::remove(path("body.node"));
    expect_error(ErrorCode::Unreadable, "body.node", [&] { read_tetrahedra(path("body.ele")); });
}

TEST_F(ReadTetrahedra, TurnsNegativeTetrahedraAndDropsUnusedVertices) {
    const std::string text = "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n";
    write("body.node", with_replaced(text, "5 3", "6 3") + "6 9 9 9\n");
    write("body.ele", "2 4 0\n1 2 1 3 4\n2 2 3 4 5\n"); // the first one is negative, the second not
    const TetrahedraFile file = read_tetrahedra(path("body.ele"));
    EXPECT_EQ(file.turned_tetrahedra, 1U);
    EXPECT_EQ(file.dropped_vertices, 1U);
    EXPECT_EQ(file.mesh.vertices.size(), 5U);
    EXPECT_NO_THROW(require_valid_tetrahedra(file.mesh));
}

TEST_F(ReadTetrahedra, RefusesFlatOnesAndThoseThatAreFoldedOverOthers) {
    TetrahedralMesh brick = make_brick(1);
    brick.tetrahedra.push_back({0, 1, 2, 3}); // the corners of a square
    expect_refused("flat.msh", encode_msh(brick), ErrorCode::InvalidMesh, "tetrahedron 6 is flat");
    TetrahedralMesh folded = make_brick(2);
    folded.vertices[13] = {3.1F, 2.9F, 3.3F}; // the middle goes out through a corner
    expect_refused("folded.vtk", encode_vtk(folded), ErrorCode::InvalidMesh,
                   "lie on the same side of a common face");
    expect_refused("twice.msh",
                   with_replaced(sample("text_2.msh"), "4 4 2 1 1 11 21 31 41", "4 4 2 1 1 1 11 21 31"),
                   ErrorCode::InvalidMesh, "lie on the same side of a common face");
}

TEST_F(ReadTetrahedra, NamesTheLineAndTheRemedyInText) {
    const std::string msh = sample("text_2.msh"), vtk = sample("text.vtk");
    expect_refused("a.msh", with_replaced(msh, "2.2 0 8", "1 0 8"), ErrorCode::WrongFormat,
                   "save the file as version 4.1");
    expect_refused("a.msh", with_replaced(msh, "2.2 0 8", "4 0 8"), ErrorCode::WrongFormat, "line 2");
    expect_refused("a.msh", with_replaced(msh, "$MeshFormat", "MeshFormat"), ErrorCode::WrongFormat,
                   "$MeshFormat");
    expect_refused("a.msh", with_replaced(msh, "$Nodes\n5", "$Nodes\n-5"), ErrorCode::Damaged,
                   "the number of nodes");
    expect_refused("a.msh", with_replaced(msh, "$Nodes\n5", "$Nodes\n4000000000"), ErrorCode::Damaged,
                   "line 15");
    expect_refused("a.msh", with_replaced(msh, "$Nodes\n5", "$Nodes\n4"), ErrorCode::Damaged,
                   "$EndNodes was expected");
    expect_refused("a.msh", with_replaced(msh, "\n11 ", "\n1 "), ErrorCode::Damaged, "there are two nodes 1");
    expect_refused("a.msh", with_replaced(msh, "11 1.5 0 0", "11 1e99 0 0"), ErrorCode::InvalidMesh,
                   "line 11");
    expect_refused("a.msh", with_replaced(msh, "1 11 21 31\n", "1 11 21 32\n"), ErrorCode::InvalidMesh,
                   "node 32, which does not exist");
    expect_refused("a.msh", with_replaced(msh, "3 4 2 1 1", "3 5 2 1 1"), ErrorCode::WrongFormat,
                   "type 5 is not a tetrahedron");
    expect_refused("a.vtk", with_replaced(vtk, "# vtk", "#vtk"), ErrorCode::WrongFormat,
                   "XML files are not read");
    expect_refused("a.vtk", with_replaced(vtk, "UNSTRUCTURED_GRID", "POLYDATA"), ErrorCode::WrongFormat,
                   "UNSTRUCTURED_GRID");
    expect_refused("a.vtk", with_replaced(vtk, "ASCII", "ASKII"), ErrorCode::WrongFormat, "line 3");
    expect_refused("a.vtk", with_replaced(vtk, "4 1 2 3 4", "4 1 2 3 5"), ErrorCode::InvalidMesh, "line 10");
    expect_refused("a.vtk", with_replaced(vtk, "CELLS 3 14", "CELLS 3 13"), ErrorCode::Damaged,
                   "14 numbers, not 13");
    expect_refused("a.vtk", with_replaced(vtk, "\n10\n", "\n24\n"), ErrorCode::WrongFormat,
                   "cell 1 of type 24");
    expect_refused("a.vtk", with_replaced(vtk, "CELL_TYPES 3", "CELL_TYPES 2"), ErrorCode::Damaged,
                   "3 cells, but 2 types");
    expect_refused("a.vtk", with_replaced(vtk, "POINTS 5 float", "POINTS 5 char"), ErrorCode::WrongFormat,
                   "'char'");
    expect_refused("a.stl", msh, ErrorCode::WrongFormat, ".msh, .vtk, .node or .ele");
    expect_refused("a.msh", "", ErrorCode::Damaged, "the file is empty");
    expect_error(ErrorCode::Unreadable, "none.msh", [&] { read_tetrahedra(path("none.msh")); });
}

TEST_F(ReadTetrahedra, NamesTheLineOfTetGensFiles) {
    const std::string node = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", ele = "1 4 0\n0 0 1 2 3\n";
    const auto expect = [&](const std::string& nodes, const std::string& elements, ErrorCode code,
                            const std::string& words) {
        write("b.node", nodes);
        expect_refused("b.ele", elements, code, words);
    };
    const auto expect_of_nodes = [&](const std::string& nodes, const std::string& words) {
        write("b.node", nodes);
        write("b.ele", ele);
        expect_error(ErrorCode::Damaged, words, [&] { read_tetrahedra(path("b.ele")); });
    };
    expect(node, with_replaced(ele, "2 3", "2 4"), ErrorCode::InvalidMesh,
           "line 2: the tetrahedron refers to point 4");
    expect(node, with_replaced(ele, "2 3", "2 -9223372036854775808"), ErrorCode::InvalidMesh,
           "refers to point -922");
    expect(node, with_replaced(ele, "1 4 0", "1 10 0"), ErrorCode::WrongFormat, "run TetGen without -o2");
    expect(node, with_replaced(ele, "1 4 0", "2 4 0"), ErrorCode::Damaged, "tetrahedron 2 of 2");
    expect(node, ele + "1 0 1 2 3\n", ErrorCode::Damaged, "continues after the 1 tetrahedra");
    expect(node, with_replaced(ele, "\n0 ", "\n1 "), ErrorCode::Damaged, "number should be 0, not 1");
    expect_of_nodes(with_replaced(node, "4 3", "4 2"), "the dimension should be 3");
    expect_of_nodes(with_replaced(node, "\n0 ", "\n2 "), "numbered from 0 or 1");
    expect_of_nodes(with_replaced(node, "\n2 ", "\n7 "), "should be 2, not 7");
    expect_of_nodes(with_replaced(node, "4 3 0", "4294967295 3 0"), "cannot be 4294967295");
}

TEST_F(ReadTetrahedra, PassesOverFieldsAndMetadataBetweenTheParts) {
    const std::string metadata = "METADATA\nINFORMATION 1\nNAME L2 LOCATION POINTS\nDATA 2 0 1.7\n\n";
    const std::string name = "FIELD FieldData 2\nTIME 1 1 double\n", cycle = "\nCYCLE 2 1 int\n";
    for (const char* file : {"text.vtk", "binary.vtk", "binary_5.vtk"}) {
        SCOPED_TRACE(file);
        const std::string content = sample(file);
        const bool is_text = content.find("ASCII") != std::string::npos;
        const std::string time = is_text ? "nan" : "\nPOINTS1";
        const std::string cycles = is_text ? "7\n-8" : std::string("\0\0\0\nPOIN", 8);
        std::string with = with_replaced(content, "POINTS", name + time + cycle + cycles + "\nPOINTS");
        with = with_replaced(with, "CELLS", metadata + "CELLS");
        EXPECT_EQ(read_tetrahedra(write("with.vtk", with)).mesh.tetrahedra,
                  read_tetrahedra(write("without.vtk", content)).mesh.tetrahedra);
    }
    const std::string text = sample("text.vtk");
    const auto with_field = [&](const std::string& field) {
        return with_replaced(text, "POINTS", field + "POINTS");
    };
    expect_refused("a.vtk", with_field("FIELD f 1\nnames 1 1 string\nx\n"), ErrorCode::WrongFormat,
                   "the array 'names' of a field does not contain numbers");
    expect_refused("a.vtk", with_field("FIELD f 2\na 1 1 int\n3\n"), ErrorCode::WrongFormat, "'POINTS'");
    expect_refused("a.vtk", with_field("FIELD f 1\na 4294967295 4294967295 int\n"), ErrorCode::Damaged,
                   "a number was expected");
    EXPECT_EQ(read_tetrahedra(write("a.vtk", with_field("FIELD f 1\na 0 4294967295 int\n"))).mesh.tetrahedra,
              read_tetrahedra(write("b.vtk", text)).mesh.tetrahedra);
}

TEST_F(ReadTetrahedra, NamesTheByteInBinaryFiles) {
    expect_refused("b.msh", with_replaced(sample("binary_2.msh"), "$Nodes\n5", "$Nodes\n4"),
                   ErrorCode::Damaged, "byte ");
    expect_refused("b.vtk", with_replaced(sample("binary.vtk"), "CELLS 2 10", "CELLS 3 15"),
                   ErrorCode::InvalidMesh, "refers to point");
    std::string wrong_mark = sample("binary_4.msh");
    wrong_mark[wrong_mark.find('\1')] = '\2';
    expect_refused("b.msh", wrong_mark, ErrorCode::Damaged, "order of bytes");
}

TEST_F(ReadTetrahedra, RefusesEveryFileThatIsCut) {
    for (const fs::path& path : samples()) {
        SCOPED_TRACE(path);
        const std::string whole = content_of(path);
        std::size_t end = whole.find_last_not_of('\n');
        // TetGen's last word is a region, which may be missing; VTK's data are none of ours.
        if (path.extension() == ".tetgen") end -= 3;
        if (path.filename() == "text.vtk") end = whole.find("POINT_DATA") - 2;
        for (std::size_t length = 0; length < end; ++length)
            ASSERT_FALSE(attack_tetrahedra(whole.substr(0, length))) << "cut at " << length;
    }
}

TEST_F(ReadTetrahedra, RefusesToWriteWhatIsNotValid) {
    expect_error(ErrorCode::InvalidMesh, "no tetrahedra", [&] { write_tetrahedra(path("c.msh"), {}); });
    expect_error(ErrorCode::WrongFormat, ".msh or .vtk, not in '.obj'",
                 [&] { write_tetrahedra(path("c.obj"), make_brick(1)); });
    EXPECT_FALSE(fs::exists(path("c.msh")));
}
