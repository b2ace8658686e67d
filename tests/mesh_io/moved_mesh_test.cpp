// write_moved_mesh(): a file whose vertices have moved, with everything else that its author put there.

#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <string>

using namespace echinus;
using namespace echinus::test;

namespace {

class MovedMesh : public TemporaryFolderTest {
  protected:
    /// The text of an OBJ file after all vertices of its faces have moved by an offset.
    std::string moved(const std::string& text, const Vec3f& offset) {
        const std::filesystem::path original = write("original.obj", text);
        TriangleMesh mesh = read_mesh(original);
        for (Vec3f& v : mesh.vertices) v = v + offset;
        write_moved_mesh(path("moved.obj"), mesh, original);
        return content_of(path("moved.obj"));
    }
};

} // namespace

TEST_F(MovedMesh, KeepsAllThatIsNoPosition) {
    EXPECT_EQ(moved("# dress\r\nmtllib a.mtl\r\no dress\r\nv 0 0 0 # left\r\nv 1.0  0\t0 0.5 0.25 1\r\n\r\nv "
                    "1 1 0\r\nv 0 1 "
                    "0\r\nvt 0 0\r\nvn 0 0 1\r\nusemtl red\r\nf 1/1/1 2/1/1 3/1/1 4/1/1\r\n",
                    {0, 0, 2.5F}),
              "# dress\r\nmtllib a.mtl\r\no dress\r\nv 0 0 2.5 # left\r\nv 1 0 2.5 0.5 0.25 1\r\n\r\nv 1 1 "
              "2.5\r\nv 0 1 "
              "2.5\r\nvt 0 0\r\nvn 0 0 1\r\nusemtl red\r\nf 1/1/1 2/1/1 3/1/1 4/1/1\r\n");
}

TEST_F(MovedMesh, MovesVerticesAtOnePositionTogetherAndLeavesThoseOfNoFace) {
    EXPECT_EQ(
        moved("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 0 1\nf 2 3 4\nf 5 6 7", {1, 0, 0}),
        "v 9 9 9\nv 1 0 0\nv 2 0 0\nv 1 1 0\nv 1 0 0\nv 2 0 0\nv 1 0 1\nf 2 3 4\nf 5 6 7");
}

TEST_F(MovedMesh, KeepsTheFrameOfAFileFarAway) {
    EXPECT_EQ(
        moved("v 448263.25 5411932.5 112\nv 448264.25 5411932.5 112\nv 448263.25 5411933.5 112\nf 1 2 3\n",
              {0.5F, 0, 0}),
        "v 448263.75 5411932.5 112\nv 448264.75 5411932.5 112\nv 448263.75 5411933.5 112\nf 1 2 3\n");
}

TEST_F(MovedMesh, IsWrittenLikeAnyMeshInOtherFormats) {
    const std::filesystem::path original =
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    const TriangleMesh mesh = read_mesh(original);
    write_moved_mesh(path("a.ply"), mesh, original);
    EXPECT_EQ(read_mesh(path("a.ply")).vertices, mesh.vertices);
    write_moved_mesh(path("b.obj"), mesh, path("a.ply"));
    EXPECT_EQ(content_of(path("b.obj")), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

TEST_F(MovedMesh, IsWrittenAsTrianglesWhereItsPolygonsWouldBeDividedInAnotherWay) {
    const std::filesystem::path original =
        write("a.obj", "v 0 0 0\nv 2 -1 0\nv 4 0 0\nv 3 3 0\nv 1 3 0\nvt 0 0\nf 1/1 2/1 3/1 4/1 5/1\n");
    TriangleMesh mesh = read_mesh(original);
    EXPECT_TRUE(write_moved_mesh(path("b.obj"), mesh, original));
    mesh.vertices[1] = {2, 2.5F, 0}; // where the polygon is concave
    mesh.vertices[0] = {0, 0, 1};
    EXPECT_FALSE(write_moved_mesh(path("b.obj"), mesh, original));
    EXPECT_EQ(read_mesh(path("b.obj")).faces, mesh.faces);
    EXPECT_FALSE(write_moved_mesh(path("c.obj"), {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 2, 1}}},
                                  write("three.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")));
}

TEST_F(MovedMesh, RefusesAnotherMeshThanThatOfTheFile) {
    const std::filesystem::path original = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const TriangleMesh other{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {1, 2, 3}}};
    expect_error(ErrorCode::InvalidMesh,
                 "a.obj: the file has 3 vertices of faces, but the mesh that moved has 4",
                 [&] { write_moved_mesh(path("b.obj"), other, original); });
    expect_error(ErrorCode::Unreadable, "none.obj",
                 [&] { write_moved_mesh(path("b.obj"), other, path("none.obj")); });
    const std::filesystem::path joined = write("c.obj", "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_error(ErrorCode::WrongFormat, "c.obj: line 1",
                 [&] { write_moved_mesh(path("b.obj"), read_mesh(joined), joined); });
    EXPECT_FALSE(std::filesystem::exists(path("b.obj")));
}
