#include "mesh_io/exported_files.hpp"
#include "mesh_io/write_mesh.hpp"
#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

#ifndef _WIN32
#include <sys/stat.h>
#endif

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

namespace {

constexpr const char* kEndings[] = {".obj", ".off", ".ply", ".stl", ".gltf", ".glb", ".3ds"};

class ReadMesh : public TemporaryFolderTest {
  protected:
    void expect_refused(ErrorCode code, const std::string& words, const fs::path& file) const {
        expect_error(code, file.string() + ": " + words, [&] { read_mesh(file); });
    }
};

} // namespace

TEST_F(ReadMesh, ReadsWhatAssimpWritesInEveryFormat) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    const TriangleMesh torus = make_torus(1, 0.25, 16, 8);
    for (const ExportedKind& kind : kExportedKinds) {
        SCOPED_TRACE(kind.exporter);
        const fs::path file = path(std::string("torus_") + kind.exporter + kind.ending);
        export_with_assimp(file, torus, kind);
        const TriangleMesh mesh = read_mesh(file);
        EXPECT_EQ(mesh.vertices.size(), torus.vertices.size());
        expect_same_faces(mesh, torus, 2e-6); // Assimp writes six digits
        EXPECT_TRUE(inspect(mesh).closed);
    }
}

TEST_F(ReadMesh, RefusesOrReadsAFileThatIsShortenedMeanwhile) {
    std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 100'000; ++i) obj += "f 1 2 3\n";
    const fs::path file = write("a.obj", obj);
    const std::jthread writer([&](const std::stop_token& done) {
        while (!done.stop_requested())
            for (const std::size_t size : {obj.size() / 2, obj.size()}) fs::resize_file(file, size);
    });
    for (int i = 0; i < 20; ++i) {
        try {
            EXPECT_FALSE(read_mesh(file).faces.empty());
        } catch (const Error& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with(file.string()));
        }
    }
}

TEST_F(ReadMesh, GivesTheSameMeshOnEachReading) {
    if (!can_export()) GTEST_SKIP() << kCannotExport;
    for (const ExportedKind& kind : kExportedKinds) {
        const fs::path file = path(std::string("box") + kind.ending);
        export_with_assimp(file, make_box({1, 2, 3}, 3), kind);
        const TriangleMesh first = read_mesh(file);
        const TriangleMesh second = read_mesh(file);
        EXPECT_EQ(first.vertices, second.vertices);
        EXPECT_EQ(first.faces, second.faces);
    }
}

TEST_F(ReadMesh, TellsFormatsByTheEndingInAnyCase) {
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    EXPECT_EQ(read_mesh(write("a.OBJ", obj)).faces.size(), 1U);
    expect_refused(ErrorCode::WrongFormat, "meshes are read from files that end in .obj",
                   write("a.txt", obj));
    expect_refused(ErrorCode::WrongFormat, "meshes are read from files that end in .obj", write("obj", obj));
}

TEST_F(ReadMesh, RefusesEmptyFilesDirectoriesAndMissingFiles) {
    for (const std::string ending : kEndings) {
        SCOPED_TRACE(ending);
        expect_refused(ErrorCode::Damaged, "the file is empty", write("empty" + ending, ""));
        fs::create_directory(path("folder" + ending));
        expect_refused(ErrorCode::Unreadable, "", path("folder" + ending));
        expect_refused(ErrorCode::Unreadable, "", path("missing" + ending));
    }
}

TEST_F(ReadMesh, RefusesAPictureByAnyName) {
    const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90wS\xde", 33);
    for (const std::string ending : kEndings) {
        SCOPED_TRACE(ending);
        expect_refused(ErrorCode::WrongFormat, "", write("picture" + ending, png));
    }
}

TEST_F(ReadMesh, RefusesFilesWithoutFaces) {
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces", write("a.obj", "v 0 0 0\nl 1 1\n"));
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces", write("a.off", "OFF\n1 0 0\n0 0 0\n"));
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces",
                   write("b.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n"));
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces", write("a.stl", "solid a\nendsolid a\n"));
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces", write("b.stl", std::string(84, '\0')));
    expect_refused(ErrorCode::InvalidMesh, "the file has no faces",
                   write("a.ply", "ply\nformat ascii 1.0\nend_header\n"));
}

TEST_F(ReadMesh, TakesASingleFaceAsAnOpenMesh) {
    const TriangleMesh mesh = read_mesh(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    EXPECT_EQ(inspect(mesh).border_edges.count, 3U);
}

TEST_F(ReadMesh, WeldsEqualPositionsAndDropsUnusedVertices) {
    const TriangleMesh mesh =
        read_mesh(write("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 0 1 0\nv 0 0 1\n"
                                 "f 2 3 4\nf 5 6 7\n"));
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(ReadMesh, ReturnsAMeshOfEqualPointsForInspectToJudge) {
    const TriangleMesh mesh = read_mesh(write("a.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"));
    EXPECT_EQ(mesh.vertices.size(), 1U);
    EXPECT_EQ(inspect(mesh).degenerate_faces.count, 1U);
}

TEST_F(ReadMesh, ReadsConcavePolygonsWithoutFacesOutside) {
    const TriangleMesh mesh =
        read_mesh(write("a.obj", "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 3 4 0\nv 3 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\n"
                                 "f 1 2 3 4 5 6 7 8\n"));
    EXPECT_EQ(mesh.faces.size(), 6U);
    EXPECT_GT(unsigned_distance(mesh, {2, 2, 0}), 0.99); // between the arms of the U
}

TEST_F(ReadMesh, KeepsHugeTinyAndFlatMeshesAsTheyAre) {
    for (const Vec3d& size : {Vec3d{1e9, 1e9, 1e9}, Vec3d{1e-9, 1e-9, 1e-9}, Vec3d{1, 1, 1e-6}}) {
        const TriangleMesh box = make_box(size, 2);
        for (const std::string ending : {".obj", ".off", ".ply", ".stl"}) {
            const fs::path file = path("box" + ending);
            write_mesh(file, box);
            const MeshReport report = inspect(read_mesh(file));
            EXPECT_TRUE(report.closed) << ending;
            EXPECT_EQ(report.vertex_count, box.vertices.size()) << ending;
            EXPECT_NEAR(report.bounding_sphere.radius / length(size), 0.5, 1e-6) << ending;
        }
    }
}

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

#ifndef _WIN32

TEST_F(ReadMesh, ReadsTheSameFromAPipe) {
    const TriangleMesh torus = make_torus(1, 0.25, 128, 64); // of more bytes than are checked first
    for (const ExportedKind& kind : kExportedKinds) {
        SCOPED_TRACE(kind.exporter);
        const fs::path file = path(std::string("torus_") + kind.exporter + kind.ending);
        const fs::path pipe = path(std::string("pipe_") + kind.exporter + kind.ending);
        export_with_assimp(file, torus, kind);
        const TriangleMesh expected = read_mesh(file);
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        const std::jthread writer(
            [&] { std::ofstream(pipe, std::ios::binary) << std::ifstream(file, std::ios::binary).rdbuf(); });
        const TriangleMesh mesh = read_mesh(pipe);
        EXPECT_EQ(mesh.vertices, expected.vertices);
        EXPECT_EQ(mesh.faces, expected.faces);
    }
}

#endif
