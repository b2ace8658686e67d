// Real models, which are not part of the repository; these tests are skipped where they are missing.

#include "judges/exact_judge.hpp"
#include "oracle/expect_right_map.hpp"
#include "oracle/wrong_share.hpp"
#include "support/point_sets.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/mesh_io.hpp>

#include <gtest/gtest.h>

#include <filesystem>

using namespace echinus;

namespace {

const std::filesystem::path kFolder = ECHINUS_SHARED_MESHES;

class DevelopmentMeshes : public testing::Test {
  protected:
    void SetUp() override {
        if (!std::filesystem::is_directory(kFolder)) GTEST_SKIP() << "the development meshes are absent";
    }
};

bool is_mesh(const std::filesystem::path& path) {
    return path.extension() == ".obj" || path.extension() == ".off";
}

} // namespace

TEST_F(DevelopmentMeshes, CentresOfAllClosedOnesAreOnTheSideThatCgalFinds) {
    int closed_count = 0;
    for (const auto& file : std::filesystem::directory_iterator(kFolder)) {
        if (!is_mesh(file)) continue;
        const TriangleMesh mesh = repair(read_mesh(file), RepairOptions::all()).mesh;
        if (!inspect(mesh).closed) continue;
        ++closed_count;
        const DistanceMap map = DistanceMap::build(mesh, {.longitude_count = 100, .colatitude_count = 50});
        EXPECT_EQ(map.view().centre_inside, test::ExactJudge(mesh).inside(map.view().centre)) << file;
        EXPECT_EQ(map.statistics().wrong_parity_share, 0) << file;
    }
    EXPECT_GE(closed_count, 10);
}

TEST_F(DevelopmentMeshes, TheHorseIsSeldomJudgedWrongly) {
    const TriangleMesh horse = read_mesh(kFolder / "horse_6k.obj");
    const test::ExactJudge judge(horse);
    const DistanceMap map = DistanceMap::build(horse, {.correction = VertexCorrection::None});
    EXPECT_LT(test::wrong_share(map, judge, test::uniform_points(horse, 15'000)), 0.15);
    EXPECT_LT(test::wrong_share(map, judge, test::surface_points(horse, 15'000)), 5);
}

TEST_F(DevelopmentMeshes, ExactMapsAreRight) {
    for (const auto& file : std::filesystem::directory_iterator(kFolder))
        if (is_mesh(file)) test::expect_right_map(file.path().stem().string(), read_mesh(file), {}, 20'000);
}
