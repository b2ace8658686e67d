// Scenes in parts: their meshes come from JavaScript.

#include "interface.hpp"
#include "scene/option_keys.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <limits>
#include <string_view>
#include <vector>

namespace echinus::wasm {

namespace {

/// The name of a model's file; empty for a generated shape.
std::string_view file_of(const SceneModel& model) {
    const auto* file = std::get_if<ModelFile>(&model);
    return file != nullptr ? file->name : std::string_view{};
}

/// The number of particles of a sheet; NaN for a mesh, whose vertices may be known only to the caller, and if
/// there are bodies.
double particle_count(const Scene& scene) {
    if (scene.mesh_cloth || !scene.bodies.empty()) return std::numeric_limits<double>::quiet_NaN();
    return scene.cloth.column_count * scene.cloth.row_count;
}

/// Numbers; the files of the model, of the cloth and of its shape at rest, and a word for each repair.
Lists describe(const Scene& scene) {
    Lists lists;
    lists.add(std::initializer_list<double>{static_cast<double>(scene.frame_limit),
                                            scene.simulation.time_step, particle_count(scene)});
    lists.add(file_of(scene.colliders.front().model));
    lists.add(scene.mesh_cloth ? file_of(scene.mesh_cloth->mesh) : std::string_view{});
    lists.add(scene.mesh_cloth && scene.mesh_cloth->rest_mesh ? file_of(*scene.mesh_cloth->rest_mesh)
                                                              : std::string_view{});
    const RepairOptions& options = scene.colliders.front().repair;
    for (const auto& [word, is_wanted] : kRepairWords)
        if (options.*is_wanted) lists.add(std::string_view(word));
    if (options.max_hole_edges != 0) lists.add(std::string_view("small_holes"));
    if (options.sheet_thickness != 0) lists.add(std::string_view("sheets"));
    return lists;
}

/// The scene's generated mesh, repaired by the scene's options.
/// @throws Error InvalidScene for a file
TriangleMesh make_model(const Scene& scene) {
    const auto make = [](const auto& model) -> TriangleMesh {
        if constexpr (std::is_same_v<std::decay_t<decltype(model)>, ModelFile>)
            throw Error(ErrorCode::InvalidScene,
                        "the scene's model is the file " + model.name + ": read it and pass its mesh");
        else
            return make_mesh(model);
    };
    return repair(std::visit(make, scene.colliders.front().model), scene.colliders.front().repair).mesh;
}

std::vector<ColliderMap> maps_at(const echinus_map* const* maps, std::uint32_t count) {
    std::vector<ColliderMap> copies; // copies share the arrays of a map
    for (const echinus_map* map : values_at(maps, count, "maps")) copies.push_back(map->value);
    return copies;
}

ClothMeshes meshes_at(const Scene& scene, const echinus_mesh* cloth, const echinus_mesh* rest,
                      const echinus_mesh* const* bodies, std::uint32_t body_count) {
    ClothMeshes meshes;
    if (cloth) meshes.mesh = cloth->value;
    if (rest) meshes.rest_mesh = rest->value;
    if (body_count > scene.bodies.size())
        throw Error(ErrorCode::InvalidOptions, "there are more meshes of bodies than bodies in the scene");
    for (std::size_t i = 0; i < body_count; ++i)
        meshes.bodies.push_back(bodies[i] ? fill_body(scene.bodies[i], bodies[i]->value) : TetrahedralMesh{});
    return meshes;
}

/// The present colliders without those that the scene no longer has, and with those that it has in addition.
/// @param maps  of all of the scene's colliders, or empty to keep the present ones
std::vector<Collider> colliders_after(const Simulation& simulation, const Scene& scene,
                                      const std::vector<ColliderMap>& maps) {
    std::vector<Collider> colliders = simulation.colliders();
    if (maps.empty()) return colliders;
    if (maps.size() != scene.colliders.size())
        throw Error(ErrorCode::InvalidOptions, "continueWith() needs a map for each collider of the scene");
    while (colliders.size() > maps.size()) colliders.pop_back();
    for (std::size_t i = colliders.size(); i < maps.size(); ++i) {
        const SceneCollider& added = scene.colliders[i];
        colliders.push_back({.map = maps[i],
                             .pose = added.pose,
                             .scale = added.scale,
                             .linear_velocity = added.linear_velocity,
                             .angular_velocity = added.angular_velocity});
    }
    return colliders;
}

/// A simulation with the scene's options, and with the particles and the colliders of another simulation in
/// their present state.
Simulation continue_with(const Simulation& simulation, const Scene& scene,
                         const std::vector<ColliderMap>& maps) {
    SimulationOptions options = scene.simulation;
    options.allow_open_colliders = simulation.options().allow_open_colliders;
    return Simulation(simulation.deformable(), colliders_after(simulation, scene, maps), options);
}

} // namespace

/// @param options  JSON, as under `map` in a scene
ECHINUS_EXPORT(wasm_map_build)
echinus_status wasm_map_build(const echinus_mesh* mesh, const char* options, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap {
        return build_map(mesh->value, parse_map_options(options, "the map's options"));
    });
}

ECHINUS_EXPORT(wasm_scene_describe)
echinus_status wasm_scene_describe(const echinus_scene* scene, echinus_array** description) {
    return make(__func__, description, [&] { return describe(scene->value).array(); });
}
ECHINUS_EXPORT(wasm_scene_make_model)
echinus_status wasm_scene_make_model(const echinus_scene* scene, echinus_mesh** model) {
    return make(__func__, model, [&] { return make_model(scene->value); });
}
ECHINUS_EXPORT(wasm_scene_build_map)
echinus_status wasm_scene_build_map(const echinus_scene* scene, const echinus_mesh* mesh, echinus_map** map) {
    return make(__func__, map, [&]() -> ColliderMap { return build_map(mesh->value, scene->value.map); });
}

/// @param maps         of the scene's colliders, in their order
/// @param cloth, rest  the meshes of a cloth from files, or null
/// @param bodies       surfaces of the bodies, each null for a generated shape
ECHINUS_EXPORT(wasm_scene_make_simulation)
echinus_status wasm_scene_make_simulation(const echinus_scene* scene, const echinus_map* const* maps,
                                          std::uint32_t map_count, std::uint32_t allow_open_colliders,
                                          const echinus_mesh* cloth, const echinus_mesh* rest,
                                          const echinus_mesh* const* bodies, std::uint32_t body_count,
                                          echinus_simulation** simulation) {
    return make(__func__, simulation, [&] {
        Scene with_choice = scene->value;
        with_choice.simulation.allow_open_colliders = allow_open_colliders != 0;
        return make_simulation(with_choice, maps_at(maps, map_count),
                               meshes_at(with_choice, cloth, rest, bodies, body_count));
    });
}
ECHINUS_EXPORT(wasm_simulation_continue)
echinus_status wasm_simulation_continue(const echinus_simulation* simulation, const echinus_scene* scene,
                                        const echinus_map* const* maps, std::uint32_t map_count,
                                        echinus_simulation** continued) {
    return make(__func__, continued,
                [&] { return continue_with(simulation->value, scene->value, maps_at(maps, map_count)); });
}

} // namespace echinus::wasm
