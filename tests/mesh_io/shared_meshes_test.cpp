#include "support/expectations.hpp"

#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <filesystem>

using namespace echinus;
using namespace echinus::test;
namespace fs = std::filesystem;

// Real meshes, which do not belong to this repository: the tests are skipped where they are absent. Their
// figures were found with another library.

namespace {

const fs::path kFolder = fs::path(ECHINUS_SHARED) / "meshes";

struct ClosedMesh {
    const char* name;
    std::size_t face_count;
    std::size_t vertex_count;
    std::size_t component_count;
    int genus; // of all components together
};

constexpr ClosedMesh kClosedMeshes[] = {
    {"horse_6k.obj", 6000, 3002, 1, 0},        {"horse_glmark2_6k.obj", 6000, 3002, 1, 0},
    {"armadillo_52k.off", 52000, 26002, 1, 0}, {"human_mannequin.obj", 8560, 4282, 1, 0},
    {"liver.off", 7416, 3710, 1, 0},           {"fertility.off", 9000, 4494, 1, 4},
    {"scorpion.obj", 12626, 6315, 1, 0},       {"fandisk.off", 12946, 6475, 1, 0},
    {"bones.off", 4204, 2154, 26, 0}};

class SharedMeshes : public testing::Test {
  protected:
    void SetUp() override {
        if (!fs::exists(kFolder)) GTEST_SKIP() << "there is no folder " << kFolder;
    }
};

} // namespace

TEST_F(SharedMeshes, ThatAreClosedAreFoundToBeSo) {
    for (const ClosedMesh& expected : kClosedMeshes) {
        SCOPED_TRACE(expected.name);
        const MeshReport report = inspect(read_mesh(kFolder / expected.name));
        EXPECT_EQ(report.face_count, expected.face_count);
        EXPECT_EQ(report.vertex_count, expected.vertex_count);
        EXPECT_EQ(report.component_count, expected.component_count);
        EXPECT_TRUE(report.closed);
        EXPECT_TRUE(report.manifold);
        EXPECT_GT(report.signed_volume, 0);
        // Euler: V - E + F = 2 components - 2 genus, and a closed mesh has 3 F / 2 edges.
        const auto characteristic =
            static_cast<int>(report.vertex_count) - static_cast<int>(report.face_count) / 2;
        EXPECT_EQ(characteristic, 2 * static_cast<int>(expected.component_count) - 2 * expected.genus);
    }
}

TEST_F(SharedMeshes, TheRawHorseHasSixDoubledCaps) {
    const TriangleMesh horse = read_mesh(kFolder / "horse_glmark2_raw.off");
    const MeshReport report = inspect(horse);
    EXPECT_EQ(report.face_count, 7172U);
    EXPECT_EQ(report.vertex_count, 3582U);
    EXPECT_FALSE(report.closed);
    EXPECT_FALSE(report.manifold);
    EXPECT_EQ(report.border_edges.count, 0U);
    EXPECT_EQ(report.nonmanifold_edges.count, 24U);
    EXPECT_EQ(report.misoriented_edges.count, 2U);
    EXPECT_EQ(report.component_count, 1U);

    const RepairedMesh repaired = repair(horse, RepairOptions::all());
    EXPECT_EQ(
        repaired.report.doubled_patch_faces_dropped,
        (std::vector<std::uint32_t>{382, 383, 637, 638, 3776, 3777, 3907, 3908, 4546, 4547, 6070, 6071}));
    EXPECT_TRUE(repaired.report.duplicate_faces_dropped.empty());
    EXPECT_EQ(repaired.report.components_flipped, 0U);
    const MeshReport after = inspect(repaired.mesh);
    EXPECT_EQ(after.face_count, 7160U);
    EXPECT_TRUE(after.closed);
    EXPECT_TRUE(after.manifold);
    EXPECT_EQ(after.vertex_count - after.face_count / 2, 2U); // genus 0
}

TEST_F(SharedMeshes, SuzanneHasMixedPolygonsAndOpenEyes) {
    const MeshReport report = inspect(read_mesh(kFolder / "suzanne.obj"));
    EXPECT_EQ(report.face_count, 968U);
    EXPECT_FALSE(report.closed);
    EXPECT_EQ(report.border_edges.count, 42U);
    EXPECT_EQ(report.nonmanifold_edges.count, 1U);
}

TEST_F(SharedMeshes, TheTeapotIsOpenAndItsPatchesAreJoinedByWelding) {
    const MeshReport report = inspect(read_mesh(kFolder / "teapot.obj"));
    EXPECT_EQ(report.face_count, 6320U);
    EXPECT_FALSE(report.closed);
    EXPECT_LT(report.vertex_count, 3644U); // the file's vertices, some at the same place
    EXPECT_GT(report.border_edges.count, 0U);
    EXPECT_LT(report.border_edges.count, 1036U); // before welding
}

TEST(InstalledHorse, ReadsAsTheListsOfTheFileInTheirOrder) {
    const fs::path installed = "/usr/share/glmark2/models/horse.3ds";
    const fs::path as_off = kFolder / "horse_glmark2_raw.off";
    if (!fs::exists(installed) || !fs::exists(as_off))
        GTEST_SKIP() << "not both of " << installed << " and " << as_off;
    const TriangleMesh horse = read_mesh(installed);
    const TriangleMesh expected = read_mesh(as_off); // written with eight digits
    EXPECT_EQ(horse.vertices.size(), expected.vertices.size());
    expect_same_faces(horse, expected, 1e-7);
}
