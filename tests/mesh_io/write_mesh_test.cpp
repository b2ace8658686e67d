#include "mesh_io/write_mesh.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

class WriteMesh : public TemporaryFolderTest {};

/// Vertices with any finite bits, none twice, all used.
TriangleMesh random_mesh(std::mt19937& random, std::size_t face_count) {
    TriangleMesh mesh;
    const auto any_float = [&] {
        for (;;)
            if (const auto f = std::bit_cast<float>(static_cast<std::uint32_t>(random())); std::isfinite(f))
                return f;
    };
    for (std::size_t face = 0; face < face_count; ++face) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 3; ++corner) {
            const float x = any_float();
            const float y = any_float();
            mesh.vertices.emplace_back(x, y, any_float());
        }
        mesh.faces.push_back({first, first + 2, first + 1});
    }
    return mesh;
}

} // namespace

TEST_F(WriteMesh, WritesFloatsThatReadBackToTheSameBits) {
    std::mt19937 random(1);
    const TriangleMesh mesh = random_mesh(random, 500);
    for (const char* name : {"a.obj", "a.off", "a.ply"}) {
        write_mesh(path(name), mesh);
        const TriangleMesh read = read_mesh(path(name));
        EXPECT_EQ(read.faces, mesh.faces) << name;
        ASSERT_EQ(read.vertices.size(), mesh.vertices.size()) << name;
        EXPECT_EQ(
            std::memcmp(read.vertices.data(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3f)), 0)
            << name;
    }
}

TEST_F(WriteMesh, KeepsTheEdgesThatNoFaceHas) {
    const MeshAndEdges flag{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 2}}, {{0, 1, 2}}},
                            {{0, 3}, {4, 3}}};
    write_mesh_and_edges(path("flag.obj"), flag);
    const MeshAndEdges read = read_mesh_and_edges(path("flag.obj"));
    EXPECT_EQ(read.mesh.vertices, flag.mesh.vertices);
    EXPECT_EQ(read.mesh.faces, flag.mesh.faces);
    EXPECT_EQ(read.edges, flag.edges);
    EXPECT_EQ(read_mesh(path("flag.obj")).vertices.size(), 3U) << "without edges, only what faces use";
}

TEST_F(WriteMesh, WritesAThreadAlone) {
    const MeshAndEdges thread{{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}}, {{0, 1}, {1, 2}}};
    write_mesh_and_edges(path("thread.obj"), thread);
    EXPECT_EQ(read_mesh_and_edges(path("thread.obj")).edges, thread.edges);
    expect_error(ErrorCode::InvalidMesh, "no faces", [&] { read_mesh(path("thread.obj")); });
}

TEST_F(WriteMesh, RefusesEdgesInAFormatWithoutLinesAndOfMissingVertices) {
    MeshAndEdges flag{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {{0, 1}}};
    expect_error(ErrorCode::WrongFormat, "end in .obj", [&] { write_mesh_and_edges(path("a.ply"), flag); });
    flag.edges = {{0, 3}};
    expect_error(ErrorCode::InvalidMesh, "vertex 3", [&] { write_mesh_and_edges(path("a.obj"), flag); });
}

TEST_F(WriteMesh, KeepsFacesAndPositionsInEveryFormat) {
    const TriangleMesh torus = make_torus(1, 0.4, 20, 12);
    for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl", "A.STL"}) {
        write_mesh(path(name), torus);
        const TriangleMesh read = read_mesh(path(name));
        expect_same_faces(read, torus);
        EXPECT_EQ(read.vertices.size(), torus.vertices.size()) << name;
    }
}

TEST_F(WriteMesh, WritesShortText) {
    const TriangleMesh mesh{{{0, 0, 0}, {0.1F, 0, 0}, {0, -1e9F, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(encode_obj(mesh), "v 0 0 0\nv 0.1 0 0\nv 0 -1e+09 0\nf 1 2 3\n");
    EXPECT_EQ(encode_off(mesh), "OFF\n3 1 0\n0 0 0\n0.1 0 0\n0 -1e+09 0\n3 0 1 2\n");
}

TEST_F(WriteMesh, GivesStlFacesUnitNormalsThatLookOut) {
    const TriangleMesh box = make_box({2, 2, 2});
    const std::string bytes = encode_stl(box);
    ASSERT_EQ(bytes.size(), 84U + 50 * box.faces.size());
    for (std::size_t face = 0; face < box.faces.size(); ++face) {
        float values[6]; // normal and first corner
        std::memcpy(values, bytes.data() + 84 + 50 * face, sizeof(values));
        const Vec3f normal{values[0], values[1], values[2]};
        EXPECT_EQ(length(normal), 1);
        EXPECT_EQ(dot(normal, Vec3f{values[3], values[4], values[5]}), 1);
    }
}

TEST_F(WriteMesh, RefusesUnknownEndingsAndInvalidMeshesWithoutLeavingAFile) {
    const TriangleMesh box = make_box({1, 1, 1});
    for (const char* name : {"a.glb", "a.txt", "a"}) {
        expect_error(ErrorCode::WrongFormat, path(name).string() + ": meshes are written to",
                     [&] { write_mesh(path(name), box); });
        EXPECT_FALSE(fs::exists(path(name)));
    }
    expect_error(ErrorCode::InvalidMesh, "no faces", [&] { write_mesh(path("a.obj"), {}); });
    expect_error(ErrorCode::InvalidMesh, "face 0", [&] { write_mesh(path("a.stl"), {{}, {{0, 1, 2}}}); });
    EXPECT_TRUE(fs::is_empty(path("")));
}

TEST_F(WriteMesh, ReportsAFolderThatIsMissingAndAFullDisk) {
    const TriangleMesh box = make_box({1, 1, 1});
    expect_error(ErrorCode::Unwritable, "missing", [&] { write_mesh(path("missing") / "a.obj", box); });
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    fs::create_symlink("/dev/full", path("full.obj"));
    expect_error(ErrorCode::Unwritable, "/dev/full", [&] { write_mesh(path("full.obj"), box); });
}
