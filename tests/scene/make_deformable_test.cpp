// Scenes whose cloth is a mesh.

#include "support/expectations.hpp"
#include "support/meshes.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

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
    EXPECT_EQ(cloth.constraints[0].rest_length, 0.25F);
    EXPECT_EQ(cloth.inverse_masses[4], 0);
    const Simulation simulation =
        make_simulation(scene, ExactMap::build(make_box({1, 1, 1})), {sheet, smaller});
    EXPECT_EQ(simulation.deformable().faces, sheet.faces);
    EXPECT_EQ(simulation.deformable().velocities[1], Vec3f(0, 0, -1));
    EXPECT_EQ(simulation.deformable().velocities[0], Vec3f());
}

TEST(SceneMeshCloth, MayBeAGeneratedShapeThatNobodyReads) {
    const Deformable bag = make_cloth(scene_with_cloth(
        R"("mesh": {"sphere": {"radius": 0.5, "segments": [12, 8]}}, "position": [0, 0, 2])"));
    EXPECT_EQ(bag.faces, make_sphere(0.5, 12, 8).faces);
    EXPECT_FALSE(bag.constraints.empty());
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

TEST(SceneAttachments, MoveWithAnyColliderOfTheScene) {
    const auto made = [](const std::string& parts) {
        return make_deformable(
            parse_scene(R"({"colliders": [{"model": {"box": {}}}, {"model": {"sphere": {}}},
            {"model": {"torus": {}}}], "solver": "newton", )" +
                            parts + "}",
                        "a.json"));
    };
    const auto expect_attached = [](const Deformable& deformable,
                                    const std::vector<std::array<std::uint32_t, 2>>& expected) {
        std::vector<std::array<std::uint32_t, 2>> found;
        for (const Attachment& a : deformable.attachments) {
            found.push_back({a.particle, a.collider});
            EXPECT_EQ(deformable.inverse_masses[a.particle], 0);
        }
        EXPECT_EQ(found, expected);
    };
    expect_attached(made(R"("cloth": {"size": [1, 1], "particles": [4, 3], "pins": [[0, 0]],
        "attachments": [{"collider": 2, "particles": [[3, 0], [1, 2]]}, {"collider": 0, "particles": [[2, 2]]}]})"),
                    {{3, 2}, {9, 2}, {10, 0}});
    expect_attached(made(R"("cloth": {"size": [1, 1], "particles": [4, 3], "attachments": [[3, 0]]})"),
                    {{3, 0}});
    expect_attached(made(R"("cloth": {"mesh": {"box": {"size": [2, 2, 2]}},
        "attachments": [{"collider": 1, "vertices": [0]}, {"collider": 2, "vertices": {"from": [1, 1, 1], "to": [1, 1, 1]}}]})"),
                    {{0, 1}, {7, 2}});
    expect_attached(
        made(
            R"("bodies": [{"mesh": {"box": {}}, "element": 1, "attachments": [{"collider": 1, "vertices": [5]}]}])"),
        {{5, 1}});
}

TEST(SceneAttachments, ToAColliderThatTheClothIgnoresArePinsThatMove) {
    for (const std::string solver : {"newton", "jakobsen"}) {
        const Scene scene = parse_scene(R"({"colliders": [{"model": {"box": {}}, "position": [0, 0, -2]},
            {"model": {"box": {"size": [0.1, 0.1, 0.1]}},
             "keyframes": [{"time": 0, "position": [1, 1, 0]}, {"time": 0.5, "position": [1, 1, 1]}]}],
            "cloth": {"size": [2, 2], "particles": [9, 9], "ignores": [1],
                      "attachments": [{"collider": 1, "particles": [[8, 8], [7, 8]]}]}, "time_step": 0.01, "solver": ")" +
                                            solver + "\"}",
                                        "a.json");
        const std::vector<ColliderMap> maps{ExactMap::build(make_box({1, 1, 1})),
                                            ExactMap::build(make_box({0.1, 0.1, 0.1}))};
        Simulation simulation = make_simulation(scene, maps);
        for (int i = 0; i < 60; ++i) simulation.step();
        EXPECT_NEAR(length(Vec3d(simulation.positions()[80]) - Vec3d{1, 1, 1}), 0, 1e-5) << solver;
        EXPECT_NEAR(length(Vec3d(simulation.positions()[79]) - Vec3d{0.75, 1, 1}), 0, 1e-5) << solver;
        EXPECT_LT(simulation.positions()[0].z, 0) << solver; // the rest of it falls
    }
}

TEST(SceneAttachments, AreRefusedByTheirKeys) {
    const auto expect_words = [](const std::string& words, const std::string& cloth) {
        test::expect_error(ErrorCode::InvalidScene, words, [&] { scene_with_cloth(cloth); });
    };
    expect_words("cloth.attachments[0].collider is 1; it must be a whole number from 0 to 0",
                 R"("mesh": "s.obj", "attachments": [{"vertices": [0], "collider": 1}])");
    expect_words("the key cloth.attachments[1].vertices is missing",
                 R"("mesh": "s.obj", "attachments": [{"vertices": [0], "collider": 0}, {"collider": 0}])");
    expect_words("the key cloth.attachments[0].collider is missing",
                 R"("size": [1, 1], "attachments": [{"particles": [[0, 0]]}])");
    expect_words(
        "there is no key \"cloth.attachments[0].vertex\"; the nearest is \"cloth.attachments[0].vertices\"",
        R"("mesh": "s.obj", "attachments": [{"vertices": [0], "collider": 0, "vertex": 1}])");
    expect_words("cloth.attachments is [[4,0]]; it must be [column, row] of particles that the cloth has",
                 R"("size": [1, 1], "particles": [4, 4], "attachments": [[4, 0]])");
    expect_words("cloth.attachments is [[1,0]]; it must be particles that are not among the pins",
                 R"("size": [1, 1], "pins": [[1, 0]], "attachments": [[1, 0]])");
}

TEST(SceneHandles, LeadParticlesOfSheetsMeshesAndBodiesAndLetGo) {
    const auto made = [](const std::string& parts) {
        return make_deformable(parse_scene(R"({"model": {"box": {}}, )" + parts + "}", "a.json")).handles;
    };
    const auto of_sheet = made(R"("cloth": {"size": [1, 1], "particles": [4, 3], "handles": [
        {"particles": [[0, 0], [3, 2]], "keyframes": [{"time": 1, "position": [1, 2, 3]}], "release": 2.5},
        {"particles": [[1, 0]]}]})");
    ASSERT_EQ(of_sheet.size(), 2u);
    EXPECT_EQ(of_sheet[0].particles, (std::vector<std::uint32_t>{0, 11}));
    ASSERT_EQ(of_sheet[0].keys.size(), 1u);
    EXPECT_EQ(of_sheet[0].keys[0].time, 1);
    EXPECT_EQ(of_sheet[0].keys[0].pose.translation, (Vec3d{1, 2, 3}));
    EXPECT_EQ(of_sheet[0].release_time, 2.5);
    EXPECT_TRUE(of_sheet[1].keys.empty());
    EXPECT_TRUE(std::isinf(of_sheet[1].release_time));
    const auto of_all = made(R"("cloth": {"mesh": {"box": {}}, "handles": [
        {"vertices": {"from": [-1, -1, 0.5], "to": [1, 1, 0.5]}}]},
        "bodies": [{"mesh": {"box": {}}, "element": 1, "handles": [{"vertices": [7], "release": 0}]}])");
    ASSERT_EQ(of_all.size(), 2u);
    EXPECT_EQ(of_all[0].particles.size(), 4u);
    EXPECT_EQ(of_all[1].particles, (std::vector<std::uint32_t>{8 + 7}));
}

TEST(SceneHandles, AreRefusedByTheirKeys) {
    const auto expect_words = [](const std::string& words, const std::string& cloth) {
        test::expect_error(ErrorCode::InvalidScene, words, [&] { scene_with_cloth(cloth); });
    };
    expect_words("cloth.handles is []; it must be an array of objects, with at least one",
                 R"("size": [1, 1], "handles": [])");
    expect_words("the key cloth.handles[0].particles is missing",
                 R"("size": [1, 1], "handles": [{"release": 1}])");
    expect_words("cloth.handles[0].release is \"soon\"; it must be a number",
                 R"("size": [1, 1], "handles": [{"particles": [[0, 0]], "release": "soon"}])");
    expect_words("cloth.handles[0].particles is [[0,0]]; it must be particles that are not among the pins",
                 R"("size": [1, 1], "pins": [[0, 0]], "handles": [{"particles": [[0, 0]]}])");
    expect_words(
        "cloth.handles[0].keyframes[1].time is 1; it must be later",
        R"("size": [1, 1], "handles": [{"particles": [[0, 0]], "keyframes": [{"time": 1}, {"time": 1}]}])");
    expect_words("the nearest is \"cloth.handles[0].release\"",
                 R"("size": [1, 1], "handles": [{"particles": [[0, 0]], "releases": 1}])");
    test::expect_error(ErrorCode::InvalidScene, "cloth.handles", [] {
        parse_scene(R"({"model": {"box": {}}, "solver": "jakobsen",
            "cloth": {"size": [1, 1], "handles": [{"particles": [[0, 0]]}]}})",
                    "a.json");
    });
}

TEST(SceneTeleports, SetClothAndModelElsewhereAtTheirTime) {
    const Scene scene = parse_scene(R"({"model": {"box": {"size": [1, 1, 0.2]}}, "gravity": [0, 0, 0],
        "cloth": {"size": [1, 1], "particles": [5, 5], "position": [0, 0, 0.4], "pins": [[0, 0]]},
        "teleports": [{"time": 0.1, "displacement": [5, 0, 0], "colliders": [0],
                       "rotation": {"axis": [0, 0, 1], "degrees": 90}},
                      {"time": 0.2, "displacement": [0, 0, -3], "colliders": [0], "deformable": false}]})",
                                    "a.json");
    Simulation simulation = make_simulation(scene, ExactMap::build(make_box({1, 1, 0.2})));
    for (int i = 0; i < 7; ++i) simulation.step();
    EXPECT_NEAR(length(Vec3d(simulation.positions()[0]) - Vec3d{5.5, -0.5, 0.4}), 0, 1e-5);
    EXPECT_NEAR(length(simulation.colliders()[0].pose.translation - Vec3d{5, 0, 0}), 0, 1e-12);
    for (int i = 0; i < 7; ++i) simulation.step();
    EXPECT_NEAR(length(Vec3d(simulation.positions()[0]) - Vec3d{5.5, -0.5, 0.4}), 0, 1e-5);
    EXPECT_NEAR(length(simulation.colliders()[0].pose.translation - Vec3d{5, 0, -3}), 0, 1e-12);
}

TEST(SceneMass, SetsAColliderFree) {
    const Scene scene =
        parse_scene(R"({"colliders": [{"model": {"box": {}}, "mass": 2, "linear_velocity": [1, 0, 0]},
        {"model": {"box": {}}, "position": [5, 5, 5]}], "cloth": {"size": [1, 1], "particles": [5, 5], "position": [0, 0, -9]}})",
                    "a.json");
    EXPECT_EQ(scene.colliders[0].mass, 2);
    EXPECT_FALSE(scene.colliders[1].mass);
    const ColliderMap box = ExactMap::build(make_box({1, 1, 1}));
    Simulation simulation = make_simulation(scene, std::vector{box, box});
    for (int i = 0; i < 30; ++i) simulation.step();
    EXPECT_NEAR(simulation.colliders()[0].pose.translation.x, 0.5, 1e-7);
    EXPECT_LT(simulation.colliders()[0].pose.translation.z, -1);
    EXPECT_EQ(simulation.colliders()[1].pose.translation, (Vec3d{5, 5, 5}));
    const auto expect_words = [](const std::string& words, const std::string& collider,
                                 const std::string& more = "") {
        test::expect_error(ErrorCode::InvalidScene, words, [&] {
            parse_scene(R"({"model": {"box": {}}, "cloth": {"size": [1, 1]}, "collider": {)" + collider +
                            "}" + more + "}",
                        "a.json");
        });
    };
    expect_words("collider.mass is 0; it must be a number from", R"("mass": 0)");
    expect_words("collider.mass is 1; it must be left out where there are keyframes",
                 R"("mass": 1, "keyframes": [{"time": 0}])");
    expect_words("collider.mass is 1; it must be left out where the model deforms",
                 R"("mass": 1, "cache": "a.pc2")");
    expect_words("solver is \"jakobsen\"", R"("mass": 1)", R"(, "solver": "jakobsen")");
}

TEST(SceneTeleports, AreRefusedByTheirKeys) {
    const auto expect_words = [](const std::string& words, const std::string& teleports,
                                 const std::string& more = "") {
        test::expect_error(ErrorCode::InvalidScene, words, [&] {
            parse_scene(R"({"model": {"box": {}}, "cloth": {"size": [1, 1]}, "teleports": )" + teleports +
                            more + "}",
                        "a.json");
        });
    };
    expect_words("the key teleports[0].time is missing", "[{}]");
    expect_words("teleports[0].colliders is [1]", R"([{"time": 1, "colliders": [1]}])");
    expect_words("teleports[0].displacement is 3", R"([{"time": 1, "displacement": 3}])");
    expect_words("teleports[0].rotation is [1,1,0,0]", R"([{"time": 1, "rotation": [1, 1, 0, 0]}])");
    expect_words("teleports[0].deformable is false; it must be true",
                 R"([{"time": 1, "deformable": false}])");
    expect_words("the nearest is \"teleports[0].displacement\"",
                 R"([{"time": 1, "displacment": [1, 0, 0]}])");
    expect_words("teleports is ", R"([{"time": 1}])", R"(, "solver": "jakobsen")");
}

TEST(SceneVelocity, TurnsAllThatIsNotPinnedAboutTheirCentreOfMass) {
    const Scene scene = parse_scene(R"({"model": {"box": {}}, "solver": "newton", "time_step": 0.001,
        "cloth": {"size": [2, 1], "particles": [5, 4], "position": [3, 4, 5], "density": 1, "angular_velocity": [0, 90, 180]},
        "bodies": [{"mesh": {"box": {}}, "element": 0.5, "pins": [0], "position": [7, 0, 0], "velocity": [1, 2, 3],
                    "angular_velocity": [360, 0, 0]}]})",
                                    "a.json");
    const Deformable made = make_deformable(scene);
    const auto velocity = [&](std::size_t i) { return Vec3d(made.velocities[i]); };
    const double pi = std::numbers::pi;
    for (std::size_t i = 0; i < 20; ++i) {
        const Vec3d expected = cross(Vec3d{0, pi / 2, pi}, Vec3d(made.positions[i]) - Vec3d{3, 4, 5});
        EXPECT_NEAR(length(velocity(i) - expected), 0, 1e-3);
    }
    EXPECT_EQ(length(velocity(20)), 0); // pinned
    Vec3d momentum, centre;
    double mass = 0;
    for (std::size_t i = 21; i < made.particle_count(); ++i) {
        const double of_particle = 1 / double{made.inverse_masses[i]};
        momentum += velocity(i) * of_particle;
        centre += Vec3d(made.positions[i]) * of_particle;
        mass += of_particle;
    }
    EXPECT_NEAR(length(momentum * (1 / mass) - Vec3d{1, 2, 3}), 0, 1e-3);
    for (std::size_t i = 21; i < made.particle_count(); ++i) {
        const Vec3d expected =
            Vec3d{1, 2, 3} + cross(Vec3d{2 * pi, 0, 0}, Vec3d(made.positions[i]) - centre * (1 / mass));
        EXPECT_NEAR(length(velocity(i) - expected), 0, 2e-3);
    }
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
    expect_refusal(ErrorCode::InvalidOptions, "s.obj: a pin refers to vertex 25",
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
    expect_invalid_scene("cloth.pins is [[0,0]]; it must be an array, each element a whole number",
                         R"("mesh": "s.obj", "pins": [[0, 0]])");
    expect_invalid_scene("the key cloth.pins.to is missing",
                         R"("mesh": "s.obj", "pins": {"from": [0, 0, 0]})");
}

// Scenes with soft bodies.

namespace {

Scene scene_with(const std::string& keys) {
    return parse_scene(R"({"model": {"box": {}}, )" + keys + "}", "a.json");
}

void expect_refusal(const std::string& words, const std::string& keys) {
    test::expect_error(ErrorCode::InvalidScene, words, [&] { scene_with(keys); });
}

double mass_of(const Deformable& deformable, std::size_t first, std::size_t count) {
    double mass = 0;
    for (std::size_t i = first; i < first + count; ++i) mass += 1 / double{deformable.inverse_masses[i]};
    return mass;
}

} // namespace

TEST(SceneBodies, AreMadeOfWhatTheirKeysSayAndNeedNoCloth) {
    const Scene scene = scene_with(R"("bodies": [{"mesh": {"box": {"size": [1, 2, 3]}}, "element": 0.5,
        "density": 900, "young_modulus": 2e4, "poisson_ratio": 0.25, "damping": 0.1, "scale": 0.5,
        "position": [0, 0, 2], "velocity": [0, 0, -1], "pins": {"from": [-9, -9, 1.5], "to": [9, 9, 1.5]}}])");
    EXPECT_FALSE(scene.has_cloth);
    EXPECT_EQ(scene.simulation.kind(), SolverKind::Newton);
    const Deformable body = make_deformable(scene);
    ASSERT_EQ(body.particle_count(), 3u * 5 * 7);
    EXPECT_EQ(body.positions[0], Vec3f(-0.25F, -0.5F, 1.25F));
    EXPECT_EQ(body.inverse_masses.back(), 0);
    const ElasticTetrahedron& tetrahedron = body.tetrahedra.front();
    EXPECT_FLOAT_EQ(tetrahedron.mu, 8000);
    EXPECT_FLOAT_EQ(tetrahedron.lambda, 8000);
    EXPECT_FLOAT_EQ(tetrahedron.damping, 0.1F);
    EXPECT_NEAR(mass_of(body, 0, 3 * 5 * 6), 900 * 0.75 * 11 / 12, 0.1);
    EXPECT_FLOAT_EQ(body.velocities[0].z, -1);
    EXPECT_EQ(body.velocities.back(), Vec3f());
}

TEST(SceneBodies, FillGeneratedShapes) {
    const Deformable body = make_deformable(
        scene_with(R"("bodies": [{"mesh": {"sphere": {"radius": 0.5}}, "element": 0.2, "density": 1}])"));
    EXPECT_NEAR(mass_of(body, 0, body.particle_count()), 4 * 3.14159 / 3 / 8, 0.05);
}

TEST(SceneBodies, FillNoSurfaceThatIsOpen) {
    const SceneBody body = scene_with(R"("bodies": [{"mesh": "ball.off", "element": 0.3}])").bodies[0];
    TriangleMesh ball = make_sphere(1, 20, 10);
    EXPECT_FALSE(fill_body(body, ball).tetrahedra.empty());
    ball.faces.pop_back();
    test::expect_error(ErrorCode::InvalidMesh, "is not closed", [&] { fill_body(body, ball); });
}

TEST(SceneBodies, FollowTheClothWhichHasItsOwnDensity) {
    const Scene scene = scene_with(R"("cloth": {"size": [2, 1], "particles": [4, 3], "density": 0.3},
        "bodies": [{"mesh": "ball.off", "element": 1, "position": [0, 0, 3]}, {"mesh": {"box": {}}, "element": 1}])");
    const TetrahedralMesh ball = make_solid_box({1, 1, 1}, {1, 1, 1});
    const Deformable all = make_deformable(scene, {.mesh = {}, .rest_mesh = {}, .bodies = {ball, {}}});
    ASSERT_EQ(all.particle_count(), 12u + 8 + 8);
    EXPECT_EQ(scene.simulation.newton().material.density, 0.3);
    EXPECT_NEAR(mass_of(all, 12, 8), 1000, 1e-3);
    EXPECT_EQ(all.positions[12], Vec3f(-0.5F, -0.5F, 2.5F));
}

TEST(SceneBodies, AndTheClothPassThroughTheCollidersThatTheyIgnore) {
    const std::string colliders = R"("colliders": [{"model": {"box": {}}}, {"model": {"sphere": {}}}])";
    const auto scene = [&](const std::string& of_cloth, const std::string& of_body) {
        return parse_scene("{" + colliders +
                               R"(, "cloth": {"size": [2, 1], "particles": [4, 3], "density": 1)" + of_cloth +
                               R"(}, "bodies": [{"mesh": {"box": {}}, "element": 1)" + of_body + "}]}",
                           "a.json");
    };
    const auto count = [](const std::vector<std::uint8_t>& passes) {
        return std::count(passes.begin(), passes.end(), std::uint8_t{1});
    };
    const Deformable all = make_deformable(scene(R"(, "ignores": [1])", R"(, "ignores": [0, 1])"));
    EXPECT_EQ(count(let_through(all, 0)), 8);
    EXPECT_EQ(count(let_through(all, 1)), 12 + 8);
    EXPECT_TRUE(let_through(make_deformable(scene("", "")), 0).empty());
    for (const char* words : {R"(, "ignores": [2])", R"(, "ignores": [-1])", R"(, "ignores": 0)"}) {
        test::expect_error(ErrorCode::InvalidScene, "cloth.ignores", [&] { scene(words, ""); });
        test::expect_error(ErrorCode::InvalidScene, "bodies[0].ignores", [&] { scene("", words); });
    }
}

TEST(SceneBodies, AreTakenAsTheyAreFromFilesOfTetrahedra) {
    for (const std::string name : {"ball.msh", "ball.VTK", "ball.node", "ball.Ele"}) {
        const Scene scene = scene_with(R"("bodies": [{"mesh": ")" + name + R"("}])");
        EXPECT_EQ(scene.bodies[0].element, 0);
        const Deformable body = make_deformable(
            scene, {.mesh = {}, .rest_mesh = {}, .bodies = {make_solid_box({1, 1, 1}, {1, 1, 1})}});
        EXPECT_EQ(body.particle_count(), 8u);
        expect_refusal("bodies[0].element is 1; it must be left out where the mesh is a file of tetrahedra",
                       R"("bodies": [{"mesh": ")" + name + R"(", "element": 1}])");
    }
    test::expect_error(ErrorCode::InvalidOptions, "bodies[0]: its mesh is the file ball.msh: read it",
                       [] { make_deformable(scene_with(R"("bodies": [{"mesh": "ball.msh"}])")); });
}

TEST(SceneBodies, ThatAreImpossibleAreRefused) {
    expect_refusal("the key bodies[0].mesh is missing", R"("bodies": [{}])");
    expect_refusal("bodies is", R"("bodies": [])");
    expect_refusal("the key bodies[1].element is missing",
                   R"("bodies": [{"mesh": "a.off", "element": 1}, {"mesh": {"torus": {}}}])");
    expect_refusal("bodies[0].poisson_ratio is 0.5",
                   R"("bodies": [{"mesh": "a.off", "element": 1, "poisson_ratio": 0.5}])");
    expect_refusal("the nearest is \"bodies[0].young_modulus\"",
                   R"("bodies": [{"mesh": "a.off", "element": 1, "young_modulu": 1}])");
    expect_refusal("\"newton\" or left out",
                   R"("solver": "jakobsen", "bodies": [{"mesh": "a.off", "element": 1}])");
    expect_refusal("material.thickness", R"("cloth": {"size": [1, 1]}, "material": {"thickness": 1})");
    test::expect_error(ErrorCode::InvalidOptions, "bodies[0]: its mesh is the file a.off: read it",
                       [] { make_deformable(scene_with(R"("bodies": [{"mesh": "a.off", "element": 1}])")); });
}

namespace fs = std::filesystem;

TEST(FindModel, TakesTheFirstFolderThatHasTheFile) {
    const fs::path root = test::folder_of_test();
    fs::remove_all(root);
    const std::array folders{root / "empty", root / "first", root / "second"};
    for (const fs::path& folder : folders) fs::create_directories(folder);
    std::ofstream(root / "first" / "horse.3ds") << "x";
    std::ofstream(root / "second" / "horse.3ds") << "x";
    std::ofstream(root / "second" / "cow.obj") << "x";
    fs::create_directory(root / "first" / "cow.obj"); // a folder of that name is no model
    EXPECT_EQ(find_model({"horse.3ds"}, folders), root / "first" / "horse.3ds");
    EXPECT_EQ(find_model({"cow.obj"}, folders), root / "second" / "cow.obj");
    EXPECT_EQ(find_model({(root / "second" / "cow.obj").string()}, folders), root / "second" / "cow.obj");
    for (const fs::path& searched : folders)
        test::expect_error(ErrorCode::Unreadable, searched.string(),
                           [&] { find_model({"pig.obj"}, folders); });
    fs::remove_all(root);
}
