#include "mesh_io/exported_files.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

using ReadMeshOnPosix = TemporaryFolderTest;

TEST_F(ReadMeshOnPosix, ReadsTheSameFromAPipe) {
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
