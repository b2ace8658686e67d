// Scenes whose cloth is a mesh.

#include "support/cloth_meshes.hpp"
#include "support/expectations.hpp"

#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <string>

using namespace echinus;

namespace {

Scene scene_with_cloth(const std::string& cloth) {
    return parse_scene(R"({"model": {"box": {}}, "cloth": {)" + cloth + "}}", "a.json");
}

void expect_refusal(ErrorCode code, const std::string& words, const std::string& cloth,
                    const ClothMeshes& meshes = {}) {
    test::expect_error(code, words, [&] { make_cloth(scene_with_cloth(cloth), meshes); });
}

} // namespace

TEST(SceneMeshCloth, IsMadeOfTheMeshThatTheCallerHasRead) {
    const TriangleMesh sheet = test::sheet_mesh(5, 5);
    TriangleMesh smaller = sheet;
    for (Vec3f& vertex : smaller.vertices) vertex *= 0.5F;
    const Scene scene = scene_with_cloth(R"("mesh": "sheet.obj", "rest_mesh": "smaller.obj", "scale": 2,
        "position": [0, 0, 3], "pins": [0, 4], "velocity": [0, 0, -1])");
    const Deformable cloth = make_cloth(scene, {sheet, smaller});
    EXPECT_EQ(cloth.positions[0], Vec3f(-1, -1, 3));
    EXPECT_EQ(cloth.sticks[0].rest_length, 0.25F);
    EXPECT_EQ(cloth.inverse_masses[4], 0);
    const Simulation simulation =
        make_simulation(scene, ExactMap::build(make_box({1, 1, 1})), {sheet, smaller});
    EXPECT_EQ(simulation.deformable().faces, sheet.faces);
    EXPECT_GT(simulation.deformable().previous_positions[1].z, simulation.positions()[1].z);
    EXPECT_EQ(simulation.deformable().previous_positions[0], simulation.positions()[0]);
}

TEST(SceneMeshCloth, MayBeAGeneratedShapeThatNobodyReads) {
    const Deformable bag = make_cloth(scene_with_cloth(
        R"("mesh": {"sphere": {"radius": 0.5, "segments": [12, 8]}}, "position": [0, 0, 2])"));
    EXPECT_EQ(bag.faces, make_sphere(0.5, 12, 8).faces);
    EXPECT_FALSE(bag.folds.empty());
}

TEST(SceneMeshCloth, ChoosesItsVerticesByABoxInTheMeshsOwnCoordinates) {
    const Deformable cloth = make_cloth(scene_with_cloth(R"("mesh": {"box": {"size": [2, 2, 2]}}, "scale": 3,
        "position": [9, 9, 9], "pins": {"from": [-1, -1, 1], "to": [0, 0, 1]},
        "attachments": {"from": [1, 1, -1], "to": [1, 1, 1]})"));
    for (std::uint32_t i = 0; i < 8; ++i) {
        const Vec3f at = (cloth.positions[i] - Vec3f{9, 9, 9}) * (1.0F / 3);
        const bool pinned = at == Vec3f{-1, -1, 1}, attached = at.x == 1 && at.y == 1;
        EXPECT_EQ(cloth.inverse_masses[i] == 0, pinned || attached) << i;
    }
    EXPECT_EQ(cloth.attachments.size(), 2u);
}

TEST(SceneMeshCloth, IsRefusedByNameWhereItsMeshesDoNotFit) {
    const TriangleMesh sheet = test::sheet_mesh(5, 5);
    expect_refusal(ErrorCode::InvalidOptions, "the scene's cloth.mesh is the file s.obj: read it",
                   R"("mesh": "s.obj")");
    expect_refusal(ErrorCode::InvalidOptions, "the scene's cloth.rest_mesh is the file r.obj: read it",
                   R"("mesh": "s.obj", "rest_mesh": "r.obj")", {sheet, {}});
    expect_refusal(ErrorCode::InvalidMesh,
                   "s.obj: its rest mesh r.obj has other vertices or faces: 16 and 18",
                   R"("mesh": "s.obj", "rest_mesh": "r.obj")", {sheet, test::sheet_mesh(4, 4)});
    expect_refusal(ErrorCode::InvalidOptions, "s.obj: a pin names vertex 25",
                   R"("mesh": "s.obj", "pins": [25])", {sheet, {}});
    expect_refusal(ErrorCode::InvalidOptions, "s.obj: none of its vertices is in the box of cloth.pins",
                   R"("mesh": "s.obj", "pins": {"from": [2, 0, 0], "to": [3, 1, 1]})", {sheet, {}});
    TriangleMesh three = sheet;
    three.vertices.emplace_back(0, 0, 1);
    three.faces.push_back({0, 6, 25});
    expect_refusal(ErrorCode::InvalidMesh, "s.obj: the edge between vertices 0 and 6", R"("mesh": "s.obj")",
                   {three, {}});
}

TEST(SceneMeshCloth, RefusesTheKeysOfASheetAndTheOtherWayRound) {
    const auto expect_invalid_scene = [](const std::string& words, const std::string& cloth) {
        test::expect_error(ErrorCode::InvalidScene, words, [&] { scene_with_cloth(cloth); });
    };
    expect_invalid_scene("cloth.size is [1,1]; it must be left out where the cloth has the key \"mesh\"",
                         R"("mesh": "s.obj", "size": [1, 1])");
    expect_invalid_scene("cloth.particles is [9,9]; it must be left out",
                         R"("mesh": "s.obj", "particles": [9, 9])");
    expect_invalid_scene("cloth.scale is 2; it must be left out, or the cloth must have the key \"mesh\"",
                         R"("size": [1, 1], "scale": 2)");
    expect_invalid_scene("cloth.bending is \"angles\"; it must be left out",
                         R"("size": [1, 1], "bending": "angles")");
    expect_invalid_scene("cloth.pins is [[0,0]]; it must be an array, each a whole number",
                         R"("mesh": "s.obj", "pins": [[0, 0]])");
    expect_invalid_scene("the key cloth.pins.to is missing",
                         R"("mesh": "s.obj", "pins": {"from": [0, 0, 0]})");
    expect_invalid_scene("cloth.bending is \"angle\"; it must be \"angles\" or \"sticks\"",
                         R"("mesh": "s.obj", "bending": "angle")");
}
