#include "support/expectations.hpp"
#include "support/temporary_folder.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>

using namespace echinus;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// A scene with every key, none at its default.
const char* const kFullScene = R"({
    "model": "horse.3ds",
    "repair": ["doubled_patches", "inside_out"],
    "map": {"kind": "distance", "directions": [128, 64], "correction": "paper", "entries": "unorm16", "pole_axis": "y"},
    "solver": "jakobsen",
    "collider": {"position": [1, 2, 3], "rotation": {"axis": [0, 0, 2], "degrees": 90}, "scale": 2.5,
                 "linear_velocity": [0.1, 0.2, 0.3], "angular_velocity": [0, 180, 0]},
    "cloth": {"particles": [20, 30], "size": [1.5, 2], "position": [4, 5, 6],
              "rotation": {"axis": [1, 0, 0], "degrees": -90}, "velocity": [1, 2, -3], "thickness": 0.02, "pins": [[0, 0], [19, 29]]},
    "material": {"structural": 1.1, "shear": 0.9, "bending": 0.2, "friction": 0.7, "drag": 0.003},
    "gravity": [0, -9.8, 0], "time_step": 0.01, "iterations": 12,
    "frame_limit": 500, "at_rest": {"distance": 0.02, "speed": 0.3, "frames": 25}
})";

/// One whose cloth is a mesh, likewise.
const char* const kMeshScene = R"({
    "model": {"torus": {"major": 2, "minor": 0.5, "segments": [12, 8]}},
    "cloth": {"mesh": "shirt.obj", "rest_mesh": "shirt_flat.obj", "scale": 0.5,
              "position": [4, 5, 6], "rotation": {"axis": [1, 0, 0], "degrees": -90}, "velocity": [1, 2, -3],
              "thickness": 0.02, "self_thickness": 0.03, "pins": [3, 5],
              "attachments": {"from": [-1, -2, -3], "to": [1, 2, 3]}},
    "collision": "surfaces_and_self", "untangle": true, "thread_count": 3
})";

std::string refusal(const std::string& text) {
    const std::string sentence =
        test::refusal_of(ErrorCode::InvalidScene, [&] { parse_scene(text, "a.json"); });
    EXPECT_TRUE(sentence.empty() || sentence.starts_with("a.json: ")) << sentence;
    return sentence;
}

/// Every object of a scene, as JSON pointers.
void collect_objects(const json& value, const json::json_pointer& at,
                     std::vector<json::json_pointer>& objects) {
    if (!value.is_object()) return;
    objects.push_back(at);
    for (const auto& item : value.items()) collect_objects(item.value(), at / item.key(), objects);
}

/// Every value of a scene that is no object, as JSON pointers.
void collect_values(const json& value, const json::json_pointer& at,
                    std::vector<json::json_pointer>& values) {
    if (!value.is_object()) return values.push_back(at);
    for (const auto& item : value.items()) collect_values(item.value(), at / item.key(), values);
}

std::string dotted(const json::json_pointer& pointer) {
    std::string path = pointer.to_string().substr(1);
    std::replace(path.begin(), path.end(), '/', '.');
    return path;
}

} // namespace

TEST(Scene, SaysHowItsModelBecomesSolid) {
    const auto with = [](const std::string& keys) {
        return parse_scene(R"({"model": "car.obj", "cloth": {"size": [1, 1]}, )" + keys + "}", "a.json")
            .colliders.front()
            .repair;
    };
    const RepairOptions options =
        with(R"("repair": ["small_holes", "inner_faces", "sheets"], "sheet_thickness": 0.02)");
    EXPECT_EQ(options.max_hole_edges, 32U);
    EXPECT_TRUE(options.drop_inner_faces);
    EXPECT_EQ(options.sheet_thickness, 0.02);
    EXPECT_EQ(with(R"("repair": ["small_holes"], "hole_edges": 8)").max_hole_edges, 8U);
    const auto refuse = [&](const std::string& keys, const std::string& words) {
        test::expect_error(ErrorCode::InvalidScene, words, [&] { with(keys); });
    };
    refuse(R"("repair": ["small_holes"], "hole_edges": 257)", "hole_edges");
    refuse(R"("hole_edges": 8)", R"("repair" must have the word "small_holes")");
    refuse(R"("sheet_thickness": 1)", R"("repair" must have the word "sheets")");
    refuse(R"("repair": ["sheets"])", "sheet_thickness");
    refuse(R"("repair": ["sheets"], "sheet_thickness": 0)", "sheet_thickness");
    const RepairOptions mended =
        with(R"("repair": ["seams", "slivers", "orientation"], "weld_distance": 0.001)");
    EXPECT_TRUE(mended.close_seams && mended.drop_loose_slivers && mended.orient_faces);
    EXPECT_EQ(mended.weld_distance, 0.001);
    EXPECT_EQ(with(R"("repair": ["seams"])").weld_distance, 0);
    refuse(R"("weld_distance": 1)", R"("repair" must have the word "seams")");
}

TEST(Scene, IsReadKeyByKey) {
    const Scene scene = parse_scene(kFullScene, "a.json");
    EXPECT_EQ(std::get<ModelFile>(scene.colliders.front().model).name, "horse.3ds");
    EXPECT_FALSE(scene.colliders.front().repair.drop_duplicate_faces);
    EXPECT_TRUE(scene.colliders.front().repair.drop_doubled_patches);
    EXPECT_TRUE(scene.colliders.front().repair.flip_inside_out);
    const auto& map = std::get<DistanceMapOptions>(scene.map);
    EXPECT_EQ(map.longitude_count, 128u);
    EXPECT_EQ(map.colatitude_count, 64u);
    EXPECT_EQ(map.correction, VertexCorrection::Paper);
    EXPECT_EQ(map.entry_format, EntryFormat::Unorm16);
    EXPECT_EQ(map.pole_axis, PoleAxis::Y);
    EXPECT_EQ(scene.colliders.front().pose.translation, (Vec3d{1, 2, 3}));
    EXPECT_NEAR(length(scene.colliders.front().pose.rotation.apply({1, 0, 0}) - Vec3d{0, 1, 0}), 0, 1e-12);
    EXPECT_EQ(scene.colliders.front().scale, (Vec3d{2.5, 2.5, 2.5}));
    EXPECT_EQ(scene.colliders.front().linear_velocity, (Vec3d{0.1, 0.2, 0.3}));
    EXPECT_NEAR(scene.colliders.front().angular_velocity.y, std::numbers::pi, 1e-12);
    EXPECT_EQ(scene.cloth.column_count, 20u);
    EXPECT_EQ(scene.cloth.row_count, 30u);
    EXPECT_EQ(scene.cloth.width, 1.5);
    EXPECT_EQ(scene.cloth.height, 2);
    EXPECT_EQ(scene.cloth.pose.translation, (Vec3d{4, 5, 6}));
    EXPECT_NEAR(length(scene.cloth.pose.rotation.apply({0, 0, 1}) - Vec3d{0, 1, 0}), 0, 1e-12);
    EXPECT_EQ(scene.cloth_velocity.linear, (Vec3d{1, 2, -3}));
    EXPECT_EQ(scene.cloth.pins, (std::vector<std::uint32_t>{0, 29 * 20 + 19}));
    EXPECT_EQ(scene.simulation.thickness, 0.02);
    EXPECT_EQ(scene.simulation.jakobsen().stiffness, (std::array{1.1, 0.9, 0.2}));
    EXPECT_EQ(scene.simulation.friction, 0.7);
    EXPECT_EQ(scene.simulation.jakobsen().drag, 0.003);
    EXPECT_EQ(scene.simulation.gravity, (Vec3d{0, -9.8, 0}));
    EXPECT_EQ(scene.simulation.time_step, 0.01);
    EXPECT_EQ(scene.simulation.jakobsen().iteration_count, 12u);
    EXPECT_EQ(scene.frame_limit, 500u);
    EXPECT_EQ(scene.simulation.rest.distance, 0.02);
    EXPECT_EQ(scene.simulation.rest.speed, 0.3);
    EXPECT_EQ(scene.simulation.rest.frame_count, 25u);
}

TEST(Scene, OfAMeshIsReadKeyByKey) {
    const Scene scene = parse_scene(kMeshScene, "a.json");
    ASSERT_TRUE(scene.mesh_cloth);
    const MeshCloth& cloth = *scene.mesh_cloth;
    EXPECT_EQ(std::get<ModelFile>(cloth.mesh).name, "shirt.obj");
    EXPECT_EQ(std::get<ModelFile>(cloth.rest_mesh.value()).name, "shirt_flat.obj");
    EXPECT_EQ(cloth.scale, 0.5);
    EXPECT_EQ(cloth.pose.translation, (Vec3d{4, 5, 6}));
    EXPECT_NEAR(length(cloth.pose.rotation.apply({0, 0, 1}) - Vec3d{0, 1, 0}), 0, 1e-12);
    EXPECT_EQ(scene.cloth_velocity.linear, (Vec3d{1, 2, -3}));
    EXPECT_EQ(scene.simulation.thickness, 0.02);
    EXPECT_EQ(scene.simulation.newton().self_thickness, 0.03);
    EXPECT_TRUE(scene.simulation.surfaces_collide());
    EXPECT_TRUE(scene.simulation.layers_collide());
    EXPECT_TRUE(scene.simulation.newton().untangle);
    EXPECT_EQ(scene.simulation.thread_count, 3u);
    EXPECT_EQ(std::get<std::vector<std::uint32_t>>(cloth.pins), (std::vector<std::uint32_t>{3, 5}));
    ASSERT_EQ(scene.cloth_attachments.size(), 1u);
    EXPECT_EQ(scene.cloth_attachments[0].collider, 0u);
    EXPECT_EQ(std::get<VertexBox>(scene.cloth_attachments[0].vertices).from, (Vec3d{-1, -2, -3}));
    EXPECT_EQ(std::get<VertexBox>(scene.cloth_attachments[0].vertices).to, (Vec3d{1, 2, 3}));
}

TEST(Scene, KeepsHalfTheSpacingAwayUnlessItHasAThickness) {
    const AnyMap map = ExactMap::build(make_box({1, 1, 1}));
    const auto thickness = [&](const std::string& key) {
        const Scene scene = parse_scene(R"({"model": {"box": {}}, "cloth": {"size": [2, 2],
            "position": [0, 0, 2], "particles": [11, 11])" +
                                            key + "}}",
                                        "a.json");
        return make_simulation(scene, map).options().thickness.value();
    };
    EXPECT_NEAR(thickness(""), 0.1, 1e-6);
    EXPECT_EQ(thickness(R"(, "thickness": 0.5)"), 0.5);
    EXPECT_EQ(thickness(R"(, "thickness": 0.02)"), 0.02);
}

TEST(Scene, NeedsOnlyAModelAndTheSizeOfTheCloth) {
    const Scene scene = parse_scene(R"({"model": {"torus": {}}, "cloth": {"size": [2, 2]}})", "a.json");
    EXPECT_EQ(std::get<TorusModel>(scene.colliders.front().model).major_segments, 60u);
    EXPECT_EQ(scene.cloth.column_count, 100u);
    EXPECT_EQ(scene.simulation.newton(), NewtonOptions{});
    EXPECT_EQ(refusal(R"({"cloth": {"size": [2, 2]}})"),
              "a.json: the key model is missing, and so is colliders; one of them is needed");
    EXPECT_EQ(refusal(R"({"model": {"torus": {}}})"), "a.json: the key cloth is missing");
    EXPECT_EQ(refusal(R"({"model": {"torus": {}}, "cloth": {}})"), "a.json: the key cloth.size is missing");
}

TEST(Scene, UsesAnExactMapUnlessItSaysOtherwise) {
    const auto map_of = [](const std::string& map) {
        return parse_scene(R"({"model": "a", "cloth": {"size": [1, 1]}, "map": )" + map + "}", "a.json").map;
    };
    EXPECT_TRUE(std::holds_alternative<ExactMapOptions>(
        parse_scene(R"({"model": "a", "cloth": {"size": [1, 1]}})", "a.json").map));
    EXPECT_TRUE(std::holds_alternative<DistanceMapOptions>(map_of(R"({"kind": "distance"})")));
    const auto given = std::get<ExactMapOptions>(
        map_of(R"({"cells_per_octant": 900, "rule": "parity", "centre": "search"})"));
    EXPECT_EQ(given.divisions, 30u);
    EXPECT_EQ(given.byte_budget, 0u);
    EXPECT_EQ(given.rule, InsideRule::Parity);
    EXPECT_EQ(given.centre, CentreChoice::Search);
    const auto budgeted = std::get<ExactMapOptions>(map_of(R"({"kind": "exact", "budget": 300000})"));
    EXPECT_EQ(budgeted.divisions, 0u);
    EXPECT_EQ(budgeted.byte_budget, 300'000u);
    const TriangleMesh box = make_box({1, 1, 1});
    EXPECT_TRUE(std::holds_alternative<ExactMap>(build_map(box, given)));
    EXPECT_TRUE(std::holds_alternative<DistanceMap>(build_map(box, DistanceMapOptions{})));
}

TEST(Scene, LetsSurfacesCollideBesideExactMapsUnlessItSaysSo) {
    const auto with = [](const std::string& keys) {
        return R"({"model": {"box": {}}, "cloth": {"size": [2, 2]})" + keys + "}";
    };
    const SimulationOptions surfaces = parse_scene(with(""), "a.json").simulation;
    EXPECT_TRUE(surfaces.surfaces_collide());
    EXPECT_TRUE(surfaces.layers_collide());
    const SimulationOptions model_only =
        parse_scene(with(R"(, "collision": "surfaces")"), "a.json").simulation;
    EXPECT_TRUE(model_only.surfaces_collide());
    EXPECT_FALSE(model_only.layers_collide());
    const SimulationOptions none = parse_scene(with(R"(, "collision": "particles")"), "a.json").simulation;
    EXPECT_FALSE(none.surfaces_collide());
    EXPECT_FALSE(none.layers_collide());
    const SimulationOptions distance =
        parse_scene(with(R"(, "map": {"kind": "distance"})"), "a.json").simulation;
    EXPECT_FALSE(distance.surfaces_collide());
    EXPECT_FALSE(distance.layers_collide());
    EXPECT_TRUE(parse_scene(with(R"(, "map": {"kind": "distance"}, "collision": "surfaces")"), "a.json")
                    .simulation.surfaces_collide());
    EXPECT_FALSE(none.newton().untangle);
    EXPECT_EQ(
        refusal(with(R"(, "collision": "particles", "untangle": true)")),
        R"(a.json: untangle is true; it must be false, or "collision" must be "surfaces" or "surfaces_and_self")");
    EXPECT_EQ(refusal(with(R"(, "collision": true)")).rfind("a.json: collision is true; it must be ", 0), 0u);
}

TEST(Scene, WarnsOfTheTwoFormerKeysOfCollisionAndTakesThemAsTheyWereMeant) {
    const auto read = [](const std::string& keys) {
        return parse_scene(R"({"model": {"box": {}}, "cloth": {"size": [2, 2]})" + keys + "}", "a.json");
    };
    const auto mode_of = [&](const std::string& keys) { return read(keys).simulation.newton().collision; };
    EXPECT_EQ(mode_of(R"(, "surface_collision": false)"), CollisionMode::Particles);
    EXPECT_EQ(mode_of(R"(, "surface_collision": true)"), CollisionMode::SurfacesAndSelf);
    EXPECT_EQ(mode_of(R"(, "self_collision": false)"), CollisionMode::Surfaces);
    EXPECT_EQ(mode_of(R"(, "map": {"kind": "distance"}, "surface_collision": true, "self_collision": false)"),
              CollisionMode::Surfaces);
    EXPECT_EQ(read(R"(, "self_collision": false)").warnings,
              (std::vector<std::string>{"a.json: the key self_collision is of an earlier version; write "
                                        "\"collision\": \"surfaces\""}));
    const auto refusal_of = [&](const std::string& keys) {
        return refusal(R"({"model": {"box": {}}, "cloth": {"size": [2, 2]})" + keys + "}");
    };
    EXPECT_EQ(refusal_of(R"(, "surface_collision": false, "self_collision": true)"),
              R"(a.json: self_collision is true; it must be false, or "surface_collision" must be true)");
    EXPECT_EQ(refusal_of(R"(, "surface_collision": 1)"),
              "a.json: surface_collision is 1; it must be true or false");
    EXPECT_NE(refusal_of(R"(, "surface_collision": true, "collision": "surfaces")").find("leave"),
              std::string::npos);
}

TEST(Scene, DividesTheDirectionsOfADistanceMapAsItSays) {
    const auto options_of = [](const std::string& keys) {
        return std::get<DistanceMapOptions>(
            parse_scene(R"({"model": "a", "cloth": {"size": [1, 1]}, "map": {"kind": "distance")" + keys +
                            "}}",
                        "a.json")
                .map);
    };
    const auto refusal_of = [](const std::string& keys) {
        return refusal(R"({"model": "a", "cloth": {"size": [1, 1]}, "map": {"kind": "distance")" + keys +
                       "}}");
    };
    EXPECT_EQ(options_of("").grid, DirectionGrid::Spherical);
    EXPECT_EQ(options_of(R"(, "grid": "cube", "divisions": 30)").grid, DirectionGrid::Cube);
    EXPECT_EQ(options_of(R"(, "grid": "octahedral", "divisions": 30)").grid, DirectionGrid::Octahedral);
    EXPECT_EQ(options_of(R"(, "grid": "octahedral", "divisions": 30)").divisions, 30u);
    EXPECT_EQ(options_of(R"(, "grid": "ellipsoidal", "pole_axis": "x")").grid, DirectionGrid::Ellipsoidal);
    EXPECT_EQ(options_of(R"(, "grid": "ellipsoidal", "pole_axis": "x")").pole_axis, PoleAxis::X);
    EXPECT_EQ(options_of("").centre, CentreChoice::BoundingSphere);
    EXPECT_EQ(options_of(R"(, "centre": "search")").centre, CentreChoice::Search);
    EXPECT_EQ(
        refusal_of(R"(, "divisions": 30)"),
        R"(a.json: map.divisions is 30; it must be left out, or "map.grid" must be "octahedral" or "cube")");
    EXPECT_EQ(
        refusal_of(R"(, "grid": "cube", "pole_axis": "x")"),
        R"(a.json: map.pole_axis is "x"; it must be left out, or "map.grid" must be "spherical" or "ellipsoidal")");
    EXPECT_NE(refusal_of(R"(, "grid": "cube", "divisions": 3)").find("map.divisions is 3"),
              std::string::npos);
    EXPECT_NE(refusal_of(R"(, "grid": "dodecahedral")").find("map.grid"), std::string::npos);
}

TEST(Scene, RefusesTheKeysOfTheOtherKindOfMap) {
    const auto refusal_of_map = [](const std::string& map) {
        return refusal(R"({"model": "a", "cloth": {"size": [1, 1]}, "map": )" + map + "}");
    };
    EXPECT_EQ(refusal_of_map(R"({"pole_axis": "y"})"),
              R"(a.json: map.pole_axis is "y"; it must be left out, or "map.kind" must be "distance")");
    EXPECT_EQ(refusal_of_map(R"({"kind": "exact", "directions": [8, 8]})"),
              R"(a.json: map.directions is [8,8]; it must be left out, or "map.kind" must be "distance")");
    EXPECT_EQ(refusal_of_map(R"({"kind": "distance", "budget": 9})"),
              R"(a.json: map.budget is 9; it must be left out, or "map.kind" must be "exact")");
    EXPECT_EQ(refusal_of_map(R"({"budget": 300000, "cells_per_octant": 9})"),
              "a.json: map.budget is 300000; it must be left out where map.cells_per_octant is given");
    EXPECT_NE(refusal_of_map(R"({"kind": "radial"})"), "");
    EXPECT_NE(refusal_of_map(R"({"budgets": 9})"), "");
}

TEST(Scene, HasTheNewtonSolverAndItsStepUnlessItSaysOtherwise) {
    const auto options_of = [](const std::string& rest) {
        return parse_scene(R"({"model": "a", "cloth": {"size": [1, 1]})" + rest + "}", "a.json").simulation;
    };
    EXPECT_EQ(options_of("").kind(), SolverKind::Newton);
    EXPECT_EQ(options_of("").time_step, 1.0 / 60);
    EXPECT_EQ(options_of(R"(, "solver": "newton")").kind(), SolverKind::Newton);
    EXPECT_EQ(options_of(R"(, "solver": "jakobsen")").kind(), SolverKind::Jakobsen);
    EXPECT_EQ(options_of(R"(, "solver": "jakobsen")").time_step, 1.0 / 240);
    EXPECT_EQ(options_of(R"(, "solver": "jakobsen", "time_step": 0.01)").time_step, 0.01);
}

TEST(Scene, OfAnEarlierVersionIsReadWithAWarningForEachKeyThatHasNoEffectAnyMore) {
    const Scene scene = parse_scene(R"({"model": "a", "solver": "xpbd", "substeps": 7, "iterations": 3,
            "multilevel": true, "time_step": 0.004, "cloth": {"mesh": "b", "bending": "constraints"},
            "material": {"structural": 1, "shear": 0.5, "bending": 0.05, "drag": 0.01, "friction": 0.25,
                         "compliance": {"structural": 1e-7, "any": 0}}})",
                                    "a.json");
    EXPECT_EQ(scene.simulation.kind(), SolverKind::Newton);
    EXPECT_EQ(scene.simulation.friction, 0.25);
    EXPECT_EQ(scene.simulation.time_step, 0.004);
    const std::vector<std::array<std::string, 2>> expected{
        {"solver", "write \"newton\", or \"jakobsen\""},
        {"iterations", "see newton_steps"},
        {"substeps", "leave it out"},
        {"multilevel", "leave it out"},
        {"cloth.bending", "from angles"},
        {"material.structural", "write material.stretch_stiffness, in N/m"},
        {"material.shear", "write material.shear_stiffness, in N/m"},
        {"material.bending", "write material.bending_stiffness, in N m"},
        {"material.drag", "write material.air_drag, in 1/s"},
        {"material.compliance", "write material.stretch_stiffness"}};
    ASSERT_EQ(scene.warnings.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const auto& [key, remedy] = expected[i];
        EXPECT_EQ(scene.warnings[i].rfind("a.json: the key " + key + " has no effect ", 0), 0u)
            << scene.warnings[i];
        EXPECT_NE(scene.warnings[i].find(remedy), std::string::npos) << scene.warnings[i];
    }
    EXPECT_EQ(parse_scene(R"({"model": "a", "solver": "verlet", "cloth": {"size": [1, 1]}})", "a.json")
                  .simulation.kind(),
              SolverKind::Newton);
}

TEST(Scene, OfThisVersionHasNoWarnings) {
    EXPECT_TRUE(parse_scene(kFullScene, "a.json").warnings.empty());
    EXPECT_TRUE(parse_scene(kMeshScene, "a.json").warnings.empty());
    const Scene scene = parse_scene(R"({"model": "a", "solver": "jakobsen", "substeps": 2,
            "cloth": {"size": [1, 1]}, "material": {"structural": 1, "drag": 0.1}})",
                                    "a.json");
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("substeps"), std::string::npos);
}

TEST(Scene, TakesTheMaterialOfTheNewtonSolver) {
    const SimulationOptions options = parse_scene(R"({"model": "a", "cloth": {"size": [1, 1]},
           "solver": "newton", "newton_steps": 7, "material": {"density": 0.3, "stretch_stiffness": 500,
           "shear_stiffness": 100, "bending_stiffness": 1e-4, "damping": 0.1}})",
                                                  "a.json")
                                          .simulation;
    EXPECT_EQ(options.kind(), SolverKind::Newton);
    EXPECT_EQ(options.time_step, 1.0 / 60);
    EXPECT_EQ(options.newton().step_count, 7u);
    EXPECT_EQ(options.newton().material.density, 0.3);
    EXPECT_EQ(options.newton().material.stretch_stiffness, 500);
    EXPECT_EQ(options.newton().material.shear_stiffness, 100);
    EXPECT_EQ(options.newton().material.bending_stiffness, 1e-4);
    EXPECT_EQ(options.newton().material.damping, 0.1);
}

TEST(Scene, HasConstraintsAndParticlesOnlyUnderJakobsensSolver) {
    const auto text = [](const std::string& cloth, const std::string& rest) {
        return R"({"model": "a", "solver": "jakobsen", "cloth": {)" + cloth + "}" + rest + "}";
    };
    const Scene scene =
        parse_scene(text(R"("mesh": "b")", R"(, "iterations": 4, "material": {"shear": 0.5})"), "a.json");
    EXPECT_EQ(scene.simulation.kind(), SolverKind::Jakobsen);
    EXPECT_EQ(scene.simulation.jakobsen().iteration_count, 4u);
    EXPECT_EQ(scene.simulation.jakobsen().stiffness[1], 0.5);
    EXPECT_FALSE(scene.simulation.surfaces_collide());
    EXPECT_FALSE(scene.simulation.layers_collide());
    const auto refusal_of = [&](const std::string& cloth, const std::string& rest) {
        return refusal(text(cloth, rest));
    };
    EXPECT_EQ(refusal_of(R"("size": [1, 1])", R"(, "collision": "surfaces")"),
              R"(a.json: collision is "surfaces"; it must be "particles", or "solver" must be "newton")");
    EXPECT_NE(refusal_of(R"("size": [1, 1])", R"(, "self_collision": true)").find("self_collision"),
              std::string::npos);
    EXPECT_NE(
        refusal_of(R"("size": [1, 1])", R"(, "collider": {"cache": "b.pc2"})").find("solver is \"jakobsen\""),
        std::string::npos);
    EXPECT_NE(refusal_of(R"("size": [1, 1], "density": 1)", R"(, "bodies": [{"mesh": "b", "element": 1}])")
                  .find("solver is \"jakobsen\""),
              std::string::npos);
}

TEST(Scene, RefusesTheKeysOfTheOtherSolver) {
    const auto refusal_of = [](const std::string& rest) {
        return refusal(R"({"model": "a", "cloth": {"size": [1, 1]}, )" + rest + "}");
    };
    EXPECT_EQ(refusal_of(R"("wind": [0, 1, 0])"), "a.json: the key wind_rate is missing");
    EXPECT_EQ(refusal_of(R"("solver": "jakobsen", "material": {"density": 1})"),
              R"(a.json: material.density is 1; it must be left out, or "solver" must be "newton")");
    EXPECT_EQ(refusal_of(R"("solver": "jakobsen", "newton_steps": 3)"),
              R"(a.json: newton_steps is 3; it must be left out, or "solver" must be "newton")");
    EXPECT_NE(refusal_of(R"("solver": "pbd")").find(R"(solver is "pbd"; it must be "newton", "jakobsen")"),
              std::string::npos);
    EXPECT_EQ(refusal_of(R"("solver": "jakobsen", "iterations": 0)"),
              "a.json: iterations is 0; it must be a whole number from 1 to 1000000");
}

TEST(Scene, ThrowsTheClothAtItsVelocityUnderEitherSolver) {
    for (const std::string rest :
         {R"("material": {"air_drag": 0})", R"("solver": "jakobsen", "material": {"drag": 0})"}) {
        const Scene scene = parse_scene(R"({"model": {"box": {}}, "gravity": [0, 0, 0], "time_step": 0.01,
            "cloth": {"size": [1, 1], "particles": [2, 2], "position": [0, 0, 5], "velocity": [0, 0, 3]}, )" +
                                            rest + "}",
                                        "a.json");
        Simulation simulation = make_simulation(scene, ExactMap::build(make_box({1, 1, 1})));
        for (int i = 0; i < 100; ++i) simulation.step();
        EXPECT_NEAR(simulation.positions()[0].z, 5 + 3, 1e-3);
    }
}

TEST(Scene, ScalesTheColliderByOneNumberOrThree) {
    const auto scale_of = [](const std::string& scale) {
        return R"({"model": "a", "cloth": {"size": [1, 1]}, "collider": {"scale": )" + scale + "}}";
    };
    EXPECT_EQ(parse_scene(scale_of("2"), "a").colliders.front().scale, (Vec3d{2, 2, 2}));
    EXPECT_EQ(parse_scene(scale_of("[1, -2, 0.5]"), "a").colliders.front().scale, (Vec3d{1, -2, 0.5}));
    for (const char* wrong : {"0", "-1", "[1, 0, 1]", "[1, 1]", "[1, 1, 1e10]", "\"2\""})
        EXPECT_EQ(refusal(scale_of(wrong)).rfind("a.json: collider.scale is ", 0), 0u) << wrong;
}

TEST(Scene, ThrowsTheClothAtItsVelocityButForThePins) {
    const Scene scene = parse_scene(R"({"model": {"box": {}}, "time_step": 0.01, "gravity": [0, 0, 0],
        "cloth": {"size": [1, 1], "particles": [2, 2], "position": [0, 0, 5],
        "velocity": [0, 0, 3], "pins": [[0, 0]]}})",
                                    "a.json");
    const Simulation simulation = make_simulation(scene, build_map(make_mesh(BoxModel{}), scene.map));
    const Deformable& cloth = simulation.deformable();
    EXPECT_EQ(cloth.velocities[0], Vec3f());
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(cloth.velocities[i], Vec3f(0, 0, 3));
}

TEST(Scene, MakesTheShapesThatItNames) {
    const auto model_of = [](const std::string& model) {
        return parse_scene(R"({"cloth": {"size": [1, 1]}, "model": )" + model + "}", "a.json")
            .colliders.front()
            .model;
    };
    const auto torus =
        std::get<TorusModel>(model_of(R"({"torus": {"major": 2, "minor": 0.5, "segments": [12, 8]}})"));
    EXPECT_EQ(make_mesh(torus).faces.size(), 12u * 8u * 2u);
    const auto sphere = std::get<SphereModel>(model_of(R"({"sphere": {"radius": 3, "segments": [10, 6]}})"));
    EXPECT_NEAR(inspect(make_mesh(sphere)).bounding_sphere.radius, 3, 1e-5);
    const auto box = std::get<BoxModel>(model_of(R"({"box": {"size": [1, 2, 3], "segments": 2}})"));
    EXPECT_NEAR(inspect(make_mesh(box)).signed_volume, 6, 1e-5);
}

TEST(Scene, RefusesAModelThatIsNoneOrTwo) {
    const std::string rest = R"(, "cloth": {"size": [1, 1]}})";
    EXPECT_NE(refusal(R"({"model": {})" + rest), "");
    EXPECT_NE(refusal(R"({"model": {"torus": {}, "box": {}})" + rest), "");
    EXPECT_NE(refusal(R"({"model": 3)" + rest), "");
    EXPECT_EQ(refusal(R"({"model": {"tours": {}})" + rest),
              R"(a.json: there is no key "model.tours"; the nearest is "model.torus")");
}

TEST(Scene, RefusesAMisspeltKeyInEveryObjectAndNamesTheRightOne) {
    std::size_t object_count = 0;
    for (const char* scene : {kFullScene, kMeshScene}) {
        const json full = json::parse(scene);
        std::vector<json::json_pointer> objects;
        collect_objects(full, json::json_pointer(), objects);
        object_count += objects.size();
        for (const auto& at : objects) {
            for (const auto& item : full[at].items()) {
                json spoilt = full;
                spoilt[at][item.key() + "x"] = item.value();
                const std::string path = dotted(at / item.key());
                EXPECT_EQ(refusal(spoilt.dump()),
                          "a.json: there is no key \"" + path + "x\"; the nearest is \"" + path + "\"");
            }
        }
    }
    EXPECT_EQ(object_count, 8u + 6u);
}

TEST(Scene, RefusesEveryValueOfAWrongTypeByItsPath) {
    for (const char* scene : {kFullScene, kMeshScene}) {
        const json full = json::parse(scene);
        std::vector<json::json_pointer> places;
        collect_values(full, json::json_pointer(), places);
        collect_objects(full, json::json_pointer(), places);
        ASSERT_GT(places.size(), 15u);
        for (const auto& at : places) {
            if (at.empty()) continue;
            for (const json& wrong : {json(nullptr), json(true), json::parse("[[]]")}) {
                if (wrong.is_boolean() && full[at].is_boolean()) continue;
                json spoilt = full;
                spoilt[at] = wrong;
                const std::string sentence = refusal(spoilt.dump());
                EXPECT_EQ(sentence.rfind("a.json: " + dotted(at) + " is ", 0), 0u) << sentence;
            }
        }
    }
    EXPECT_NE(refusal("[]"), "");
    EXPECT_NE(refusal("3"), "");
}

TEST(Scene, RefusesEveryNumberOutOfRangeByItsPath) {
    const json full = json::parse(kFullScene);
    std::vector<json::json_pointer> places;
    collect_values(full, json::json_pointer(), places);
    for (const auto& at : places) {
        const json& value = full[at];
        if (!value.is_number() && !(value.is_array() && value[0].is_number())) continue;
        json spoilt = full;
        const bool any_sign = value.is_array() && value.size() == 3;
        const double wrong = any_sign ? 1e12 : -1;
        (value.is_array() ? spoilt[at][0] : spoilt[at]) = wrong;
        if (dotted(at).ends_with("degrees")) spoilt[at] = 1e12;
        const std::string sentence = refusal(spoilt.dump());
        EXPECT_EQ(sentence.rfind("a.json: " + dotted(at) + " is ", 0), 0u) << sentence;
    }
    EXPECT_NE(
        refusal(
            R"({"model": "a", "cloth": {"size": [1, 1], "rotation": {"axis": [0, 0, 0], "degrees": 1}}})"),
        "");
}

TEST(Scene, RefusesAPinOutsideTheCloth) {
    const auto pinned = [](const std::string& pins) {
        return refusal(R"({"model": "a", "cloth": {"size": [1, 1], "particles": [3, 4], "pins": )" + pins +
                       "}}");
    };
    EXPECT_EQ(pinned("[[2, 3]]"), "");
    EXPECT_NE(pinned("[[3, 0]]"), "");
    EXPECT_NE(pinned("[[0, 4]]"), "");
}

TEST(SceneFile, ThatCannotBeReadIsRefusedByName) {
    const fs::path folder = test::folder_of_test();
    fs::create_directories(folder);
    std::ofstream(folder / "empty.json");
    std::ofstream(folder / "huge.json") << std::string(2'000'000, ' ');
    const auto expect_refused = [](ErrorCode code, const fs::path& path) {
        test::expect_error(code, path.string() + ": ", [&] { read_scene(path); });
    };
    expect_refused(ErrorCode::Unreadable, folder);
    expect_refused(ErrorCode::Unreadable, folder / "missing.json");
    expect_refused(ErrorCode::InvalidScene, folder / "empty.json");
    expect_refused(ErrorCode::InvalidScene, folder / "huge.json");
    fs::remove_all(folder);
}

TEST(SceneFile, OfTheRepositoryIsSound) {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(ECHINUS_SCENES)) {
        if (entry.path().extension() != ".json") continue;
        EXPECT_NO_THROW(read_scene(entry.path())) << entry.path();
        ++count;
    }
    EXPECT_GE(count, 5u);
}

// ---- Colliders that move, deform, and are several

namespace {

std::string with_collider(const std::string& collider) {
    return R"({"model": "a.obj", "cloth": {"size": [1, 1]}, "collider": )" + collider + "}";
}

} // namespace

TEST(Scene, LeadsAColliderAlongKeyframes) {
    const Scene scene = parse_scene(with_collider(R"({"scale": 2, "keyframes": [
        {"time": -1, "position": [0, 0, 0]},
        {"time": 1, "position": [4, 0, 0], "rotation": {"axis": [0, 0, 1], "degrees": 90}},
        {"time": 2, "position": [4, 1, 0], "rotation": [0, 0, 0, 1]}]})"),
                                    "a.json");
    const SceneCollider& collider = scene.colliders.front();
    ASSERT_EQ(collider.keyframes.size(), 3u);
    EXPECT_EQ(collider.scale.x, 2);
    EXPECT_EQ(collider.keyframes[1].time, 1);
    EXPECT_EQ(collider.keyframes[2].pose.rotation.z, 1);
    EXPECT_NEAR(length(collider.keyframes[1].pose.rotation.apply({1, 0, 0}) - Vec3d{0, 1, 0}), 0, 1e-12);
    // It begins where the keys have it at 0 s.
    EXPECT_NEAR(length(collider.pose.translation - Vec3d{2, 0, 0}), 0, 1e-12);
}

TEST(Scene, RefusesKeyframesThatMakeNoSense) {
    EXPECT_EQ(
        refusal(with_collider(R"({"keyframes": [{"time": 0}, {"time": 0}]})")),
        "a.json: collider.keyframes[1].time is 0; it must be later than that of the keyframe before it");
    EXPECT_EQ(refusal(with_collider(R"({"keyframes": [{"time": 0, "position": [0, 0]}]})")),
              "a.json: collider.keyframes[0].position is [0,0]; it must be an array of 3 elements, each a "
              "number from -1e+09 to 1e+09");
    EXPECT_EQ(refusal(with_collider(R"({"keyframes": [{"position": [0, 0, 0]}]})")),
              "a.json: the key collider.keyframes[0].time is missing");
    EXPECT_EQ(refusal(with_collider(R"({"keyframes": [{"time": 0, "rotation": [1, 1, 0, 0]}]})")),
              "a.json: collider.keyframes[0].rotation is [1,1,0,0]; it must be a quaternion [w, x, y, z] of "
              "length 1");
    EXPECT_EQ(refusal(with_collider(R"({"keyframes": []})")),
              "a.json: collider.keyframes is []; it must be an array of objects, with at least one");
    EXPECT_EQ(refusal(with_collider(R"({"position": [0, 0, 1], "keyframes": [{"time": 0}]})")),
              "a.json: collider.position is [0,0,1]; it must be left out where there are keyframes");
    EXPECT_EQ(refusal(with_collider(R"({"keyframes": [{"time": 0, "scale": 1}]})")),
              "a.json: there is no key \"collider.keyframes[0].scale\"; the nearest is "
              "\"collider.keyframes[0].time\"");
}

TEST(Scene, HasSeveralCollidersEachWithItsModelAndMotion) {
    const Scene scene = parse_scene(R"({"cloth": {"size": [1, 1], "position": [0, 0, 2]}, "colliders": [
        {"model": {"sphere": {"radius": 0.5}}, "linear_velocity": [0, 0, 1]},
        {"model": {"box": {}}, "position": [0, 0, -3], "scale": [1, 2, 3]}]})",
                                    "a.json");
    ASSERT_EQ(scene.colliders.size(), 2u);
    EXPECT_EQ(std::get<SphereModel>(scene.colliders[0].model).radius, 0.5);
    EXPECT_EQ(scene.colliders[0].linear_velocity.z, 1);
    EXPECT_EQ(scene.colliders[1].scale.z, 3);
    const std::vector<ColliderMap> maps{build_map(make_mesh(SphereModel{.radius = 0.5}), scene.map),
                                        build_map(make_mesh(BoxModel{}), scene.map)};
    Simulation simulation = make_simulation(scene, maps);
    simulation.step();
    EXPECT_GT(simulation.colliders()[0].pose.translation.z, 0);
    EXPECT_EQ(simulation.colliders()[1].pose.translation.z, -3);
    test::expect_error(ErrorCode::InvalidOptions,
                       "the scene has 2 colliders, and make_simulation() got 1 maps; it takes one for each",
                       [&] { make_simulation(scene, maps.front()); });
    EXPECT_EQ(refusal(R"({"model": "a", "cloth": {"size": [1, 1]}, "colliders": [{"model": "b"}]})"),
              "a.json: model is \"a\"; it must be left out where there is the key \"colliders\"");
    EXPECT_EQ(refusal(R"({"cloth": {"size": [1, 1]}, "colliders": [{"model": "b"}, {}]})"),
              "a.json: the key colliders[1].model is missing");
}

TEST(Scene, NamesTheCacheThatDeformsACollider) {
    const Scene short_form = parse_scene(with_collider(R"({"cache": "walk.pc2"})"), "a.json");
    EXPECT_EQ(short_form.colliders.front().cache->name, "walk.pc2");
    EXPECT_EQ(short_form.colliders.front().cache->frames_per_second, 24);
    const Scene scene =
        parse_scene(with_collider(R"({"cache": {"file": "walk", "frames_per_second": 30}})"), "a.json");
    EXPECT_EQ(scene.colliders.front().cache->name, "walk");
    EXPECT_EQ(scene.colliders.front().cache->frames_per_second, 30);
    EXPECT_EQ(refusal(with_collider(R"({"cache": {"frames_per_second": 30}})")),
              "a.json: the key collider.cache.file is missing");
    EXPECT_EQ(refusal(with_collider(R"({"cache": ""})")),
              "a.json: collider.cache is \"\"; it must be the name of a file or folder");
    EXPECT_EQ(refusal(with_collider(R"({"cache": {"file": ""}})")),
              "a.json: collider.cache.file is \"\"; it must be the name of a file or folder");
    EXPECT_NE(refusal(R"({"model": "a", "cloth": {"size": [1, 1]}, "collision": "particles",
                          "collider": {"cache": "b"}})")
                  .find("since a collider has a vertex cache"),
              std::string::npos);
    EXPECT_THROW(make_simulation(scene, ExactMap::build(make_box({1, 1, 1}))), Error);
}
