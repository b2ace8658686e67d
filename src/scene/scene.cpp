#include "files/text.hpp"

#include <echinus/error.hpp>
#include <echinus_scene/scene.hpp>

#include <string>
#include <utility>
#include <vector>

namespace echinus {

namespace fs = std::filesystem;

namespace {

/// @param is_right  returns whether a path is the right one
template <typename IsRight>
fs::path find(const std::string& name, std::span<const fs::path> folders, const char* what,
              const IsRight& is_right) {
    std::string tried;
    for (const fs::path& folder : folders) {
        const fs::path path = folder / utf8_path(name); // an absolute name replaces the folder
        if (is_right(path)) return path;
        tried += (tried.empty() ? "" : ", ") + folder.string();
    }
    if (utf8_path(name).is_absolute())
        throw Error(ErrorCode::Unreadable, what + name + " does not exist, or is not a file");
    throw Error(ErrorCode::Unreadable, std::string(what) + name + " is in none of the folders " + tried +
                                           "; scripts/setup puts the models of the scenes into models/");
}

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

} // namespace

fs::path find_model(const ModelFile& model, std::span<const fs::path> folders) {
    return find(model.name, folders, "the mesh ", is_file);
}

fs::path find_cache(const CacheFile& cache, std::span<const fs::path> folders) {
    return find(cache.name, folders, "the vertex cache ", [](const fs::path& path) {
        std::error_code ignored;
        return is_file(path) || fs::is_directory(path, ignored);
    });
}

TriangleMesh make_mesh(const TorusModel& model) {
    return make_torus(model.major_radius, model.minor_radius, model.major_segments, model.minor_segments);
}

TriangleMesh make_mesh(const SphereModel& model) {
    return make_sphere(model.radius, model.meridian_count, model.parallel_count);
}

TriangleMesh make_mesh(const BoxModel& model) {
    return make_box(model.size, model.segments);
}

AnyMap build_map(const TriangleMesh& mesh, const MapOptions& options, unsigned thread_count) {
    if (const auto* exact = std::get_if<ExactMapOptions>(&options)) {
        ExactMapOptions with_threads = *exact;
        with_threads.thread_count = thread_count;
        return ExactMap::build(mesh, with_threads);
    }
    DistanceMapOptions with_threads = std::get<DistanceMapOptions>(options);
    with_threads.thread_count = thread_count;
    return DistanceMap::build(mesh, with_threads);
}

namespace {

/// The name of a model in sentences.
struct NameOfModel {
    std::string operator()(const ModelFile& file) const { return utf8_path(file.name).filename().string(); }
    std::string operator()(const TorusModel&) const { return "the torus"; }
    std::string operator()(const SphereModel&) const { return "the sphere"; }
    std::string operator()(const BoxModel&) const { return "the box"; }
};

} // namespace

Collider make_collider(const SceneCollider& collider, const ColliderMap& map) {
    return {.map = map,
            .pose = collider.pose,
            .scale = collider.scale,
            .linear_velocity = collider.linear_velocity,
            .angular_velocity = collider.angular_velocity,
            .name = std::visit(NameOfModel{}, collider.model)};
}

ColliderMap make_collider_map(const Scene& scene, const TriangleMesh& mesh, unsigned thread_count) {
    ColliderMap map(build_map(mesh, scene.map, thread_count));
    if (scene.simulation.surfaces_collide() && !std::holds_alternative<ExactMap>(map.kind))
        map.surface = ExactMap::build(mesh, {.thread_count = thread_count});
    return map;
}

Simulation make_simulation(const Scene& scene, std::span<const ColliderMap> maps, const ClothMeshes& meshes,
                           std::span<const VertexCache> caches) {
    if (maps.size() != scene.colliders.size())
        throw Error(ErrorCode::InvalidOptions, "the scene has " + std::to_string(scene.colliders.size()) +
                                                   " colliders, and make_simulation() got " +
                                                   std::to_string(maps.size()) +
                                                   " maps; it takes one for each");
    for (std::size_t c = 0; c < maps.size(); ++c)
        if (scene.colliders[c].cache && (c >= caches.size() || caches[c].samples == nullptr))
            throw Error(ErrorCode::InvalidOptions,
                        "collider " + std::to_string(c) + " has the vertex cache " +
                            scene.colliders[c].cache->name +
                            ", which was not given; read it with read_vertex_cache(), or remove it from the "
                            "scene");
    std::vector<Collider> colliders;
    for (std::size_t c = 0; c < maps.size(); ++c)
        colliders.push_back(make_collider(scene.colliders[c], maps[c]));
    Simulation simulation(make_deformable(scene, meshes), std::move(colliders), scene.simulation);
    for (std::size_t c = 0; c < maps.size(); ++c)
        if (!scene.colliders[c].keyframes.empty())
            simulation.set_collider_keyframes(c, scene.colliders[c].keyframes);
    for (std::size_t c = 0; c < maps.size(); ++c)
        if (scene.colliders[c].cache) simulation.set_collider_cache(c, caches[c]);
    for (std::size_t c = 0; c < maps.size(); ++c)
        if (scene.colliders[c].mass) simulation.set_collider_free(c, *scene.colliders[c].mass);
    for (const Teleport& teleport : scene.teleports) simulation.teleport(teleport);
    return simulation;
}

Simulation make_simulation(const Scene& scene, const ColliderMap& map, const ClothMeshes& meshes) {
    return make_simulation(scene, std::span(&map, 1), meshes);
}

} // namespace echinus
