// Scenes and simulations.

#include "interface.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <vector>

namespace echinus::wasm {

namespace {

json to_json(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

json to_json(const SceneModel& model) {
    if (const auto* file = std::get_if<ModelFile>(&model)) return file->name;
    return nullptr;
}

/// The names of the files that the scene's cloth is made of.
json cloth_files(const Scene& scene) {
    json files = {{"clothFile", nullptr}, {"clothRestFile", nullptr}};
    if (!scene.mesh_cloth) return files;
    files["clothFile"] = to_json(scene.mesh_cloth->mesh);
    if (scene.mesh_cloth->rest_mesh) files["clothRestFile"] = to_json(*scene.mesh_cloth->rest_mesh);
    return files;
}

/// Null for a mesh, whose vertices may be known to the caller only, and beside bodies.
json particle_count(const Scene& scene) {
    if (scene.mesh_cloth || !scene.bodies.empty()) return nullptr;
    return scene.cloth.column_count * scene.cloth.row_count;
}

json describe(const Scene& scene) {
    json repairs = json::array();
    if (scene.colliders.front().repair.drop_duplicate_faces) repairs.push_back("duplicate_faces");
    if (scene.colliders.front().repair.drop_doubled_patches) repairs.push_back("doubled_patches");
    if (scene.colliders.front().repair.max_hole_edges != 0) repairs.push_back("small_holes");
    if (scene.colliders.front().repair.flip_inside_out) repairs.push_back("inside_out");
    if (scene.colliders.front().repair.drop_inner_faces) repairs.push_back("inner_faces");
    if (scene.colliders.front().repair.sheet_thickness != 0) repairs.push_back("sheets");
    if (scene.colliders.front().repair.close_seams) repairs.push_back("seams");
    if (scene.colliders.front().repair.drop_loose_slivers) repairs.push_back("slivers");
    if (scene.colliders.front().repair.orient_faces) repairs.push_back("orientation");
    json description = cloth_files(scene);
    description.update({{"modelFile", to_json(scene.colliders.front().model)},
                        {"repair", repairs},
                        {"frameLimit", scene.frame_limit},
                        {"timeStep", scene.simulation.time_step},
                        {"particleCount", particle_count(scene)}});
    return description;
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

json to_json(const SimulationProfile& profile) {
    return {{"integrationSeconds", profile.integration_seconds},
            {"constraintSeconds", profile.constraint_seconds},
            {"collisionSeconds", profile.collision_seconds},
            {"queryCount", profile.query_count},
            {"contactCount", profile.contact_count},
            {"mapQueryCount", profile.map_query_count},
            {"rescuedCount", profile.rescued_count},
            {"lostCount", profile.lost_count},
            {"truncatedCount", profile.truncated_count},
            {"searchedFaceCount", profile.searched_face_count},
            {"measuredPairCount", profile.measured_pair_count},
            {"squeezedCount", profile.squeezed_count}};
}

json to_json(const Collider& collider) {
    const Rotation& r = collider.pose.rotation;
    return {{"position", to_json(collider.pose.translation)},
            {"rotation", {r.w, r.x, r.y, r.z}},
            {"scale", to_json(collider.scale)},
            {"linearVelocity", to_json(collider.linear_velocity)},
            {"angularVelocity", to_json(collider.angular_velocity)}};
}

const Collider& collider_of(const Simulation& simulation) {
    return simulation.colliders().front();
}

/// Objects that JavaScript names by their addresses.
template <typename Object>
using Addresses = const Object* const*;

std::vector<ColliderMap> maps_at(Addresses<AnyMap> maps, std::uint32_t count) {
    std::vector<ColliderMap> copies; // they share the arrays
    for (const AnyMap* map : values_at(maps, count)) copies.emplace_back(*map);
    return copies;
}

ClothMeshes meshes_at(const Scene& scene, const TriangleMesh* cloth, const TriangleMesh* rest,
                      Addresses<TriangleMesh> bodies, std::uint32_t body_count) {
    ClothMeshes meshes;
    if (cloth) meshes.mesh = *cloth;
    if (rest) meshes.rest_mesh = *rest;
    if (body_count > scene.bodies.size())
        throw Error(ErrorCode::InvalidOptions, "there are more meshes of bodies than bodies in the scene");
    for (std::size_t i = 0; i < body_count; ++i)
        meshes.bodies.push_back(bodies[i] ? fill_body(scene.bodies[i], *bodies[i]) : TetrahedralMesh{});
    return meshes;
}

/// The present colliders, with those that the scene has more of; without those that it has no longer.
/// @param maps  of all of the scene's colliders, or none, to keep the present ones
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

/// The scene's options, with the particles and the colliders of a simulation in their present state.
Simulation continue_with(const Simulation& simulation, const Scene& scene,
                         const std::vector<ColliderMap>& maps) {
    SimulationOptions options = scene.simulation;
    options.allow_open_colliders = simulation.options().allow_open_colliders;
    return Simulation(simulation.deformable(), colliders_after(simulation, scene, maps), options);
}

} // namespace

ECHINUS_EXPORT(scene_parse)
Scene* scene_parse(const char* text, std::uint32_t size, const char* name, std::uint32_t name_size) {
    return make_handle(
        [&] { return parse_scene(text_at(text, size), std::string(text_at(name, name_size))); });
}
ECHINUS_EXPORT(scene_describe) Text* scene_describe(const Scene* scene) {
    return make_json([&] { return describe(*scene); });
}
ECHINUS_EXPORT(scene_make_model) TriangleMesh* scene_make_model(const Scene* scene) {
    return make_handle([&] { return make_model(*scene); });
}
ECHINUS_EXPORT(scene_build_map) AnyMap* scene_build_map(const Scene* scene, const TriangleMesh* mesh) {
    return make_handle([&] { return build_map(*mesh, scene->map); });
}
ECHINUS_EXPORT(scene_delete) void scene_delete(Scene* scene) {
    delete scene;
}

/// @param maps         of the scene's colliders, in their order
/// @param cloth, rest  meshes of a cloth that is made of files, or null
/// @param bodies       surfaces of the bodies, each null for a generated shape
ECHINUS_EXPORT(simulation_make)
Simulation* simulation_make(const Scene* scene, Addresses<AnyMap> maps, std::uint32_t map_count,
                            bool allow_open_collider, const TriangleMesh* cloth, const TriangleMesh* rest,
                            Addresses<TriangleMesh> bodies, std::uint32_t body_count) {
    return make_handle([&] {
        Scene with_choice = *scene;
        with_choice.simulation.allow_open_colliders = allow_open_collider;
        return make_simulation(with_choice, maps_at(maps, map_count),
                               meshes_at(*scene, cloth, rest, bodies, body_count));
    });
}
ECHINUS_EXPORT(simulation_continue)
Simulation* simulation_continue(const Simulation* simulation, const Scene* scene, Addresses<AnyMap> maps,
                                std::uint32_t map_count) {
    return make_handle([&] { return continue_with(*simulation, *scene, maps_at(maps, map_count)); });
}
ECHINUS_EXPORT(simulation_delete) void simulation_delete(Simulation* simulation) {
    delete simulation;
}

ECHINUS_EXPORT(simulation_step) bool simulation_step(Simulation* simulation, std::uint32_t frame_count) {
    return guarded([&] {
        for (std::uint32_t i = 0; i < frame_count; ++i) simulation->step();
        return true;
    });
}

ECHINUS_EXPORT(simulation_particle_count)
std::uint32_t simulation_particle_count(const Simulation* simulation) {
    return static_cast<std::uint32_t>(simulation->positions().size());
}
ECHINUS_EXPORT(simulation_positions) const Vec3f* simulation_positions(const Simulation* simulation) {
    return simulation->positions().data();
}
ECHINUS_EXPORT(simulation_previous_positions)
const Vec3f* simulation_previous_positions(const Simulation* simulation) {
    return simulation->deformable().previous_positions.data();
}
ECHINUS_EXPORT(simulation_faces) const Triangle* simulation_faces(const Simulation* simulation) {
    return simulation->deformable().faces.data();
}
ECHINUS_EXPORT(simulation_face_count) std::uint32_t simulation_face_count(const Simulation* simulation) {
    return static_cast<std::uint32_t>(simulation->deformable().faces.size());
}

ECHINUS_EXPORT(simulation_frame) std::uint32_t simulation_frame(const Simulation* simulation) {
    return simulation->frame();
}
ECHINUS_EXPORT(simulation_at_rest) bool simulation_at_rest(const Simulation* simulation) {
    return simulation->at_rest();
}
ECHINUS_EXPORT(simulation_largest_speed) double simulation_largest_speed(const Simulation* simulation) {
    return simulation->largest_speed();
}
ECHINUS_EXPORT(simulation_state_hash) std::uint64_t simulation_state_hash(const Simulation* simulation) {
    return simulation->state_hash();
}
ECHINUS_EXPORT(simulation_residual) Text* simulation_residual(const Simulation* simulation) {
    return make_json([&] {
        const Residual residual = simulation->residual();
        return json{{"rootMeanSquare", residual.root_mean_square}, {"largest", residual.largest}};
    });
}
ECHINUS_EXPORT(simulation_profile) Text* simulation_profile(const Simulation* simulation) {
    return make_json([&] { return to_json(simulation->profile()); });
}

// ---- The colliders of the scene

ECHINUS_EXPORT(simulation_collider_count)
std::uint32_t simulation_collider_count(const Simulation* simulation) {
    return static_cast<std::uint32_t>(simulation->colliders().size());
}
/// @pre index < simulation_collider_count(), as for the others
ECHINUS_EXPORT(simulation_collider)
Text* simulation_collider(const Simulation* simulation, std::uint32_t index) {
    return make_json([&] { return to_json(simulation->colliders()[index]); });
}
ECHINUS_EXPORT(simulation_set_collider_velocity)
void simulation_set_collider_velocity(Simulation* simulation, std::uint32_t index, double linear_x,
                                      double linear_y, double linear_z, double angular_x, double angular_y,
                                      double angular_z) {
    simulation->set_collider_velocity(index, {linear_x, linear_y, linear_z},
                                      {angular_x, angular_y, angular_z});
}
ECHINUS_EXPORT(simulation_set_collider_vertices)
bool simulation_set_collider_vertices(Simulation* simulation, std::uint32_t index, const Vec3f* vertices,
                                      std::uint32_t count) {
    return guarded([&] {
        simulation->set_collider_vertices(index, values_at(vertices, count));
        return true;
    });
}

// ---- A hand and wind

ECHINUS_EXPORT(simulation_set_particle_velocity)
void simulation_set_particle_velocity(Simulation* simulation, std::uint32_t particle, double x, double y,
                                      double z) {
    simulation->set_particle_velocity(particle, {x, y, z});
}
ECHINUS_EXPORT(simulation_blow)
bool simulation_blow(Simulation* simulation, double x, double y, double z, double rate) {
    return guarded([&] {
        simulation->blow({x, y, z}, rate);
        return true;
    });
}

/// Which particles are inside the collider now, by its map.
ECHINUS_EXPORT(simulation_contains_batch)
void simulation_contains_batch(const Simulation* simulation, std::uint8_t* inside) {
    contains_batch(collider_of(*simulation), simulation->positions(),
                   {inside, simulation->positions().size()});
}
ECHINUS_EXPORT(simulation_contacts_batch)
void simulation_contacts_batch(const Simulation* simulation, float margin_world, Contact* contacts) {
    contacts_batch(collider_of(*simulation), simulation->positions(), margin_world,
                   {contacts, simulation->positions().size()});
}

} // namespace echinus::wasm
