#include "commands/loaded_colliders.hpp"

#include "commands/scene_model.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <optional>
#include <utility>
#include <variant>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

/// The exact map that judges a model: that of the scene, or its own.
ExactMap judge_of(const AnyMap& map, const TriangleMesh& mesh, unsigned thread_count) {
    if (const auto* exact = std::get_if<ExactMap>(&map)) return *exact;
    return ExactMap::build(mesh, {.thread_count = thread_count});
}

} // namespace

TriangleMesh LoadedColliders::mesh_at(std::size_t collider, double seconds) const {
    TriangleMesh mesh = judged[collider].mesh;
    if (deforms(collider)) mesh.vertices = vertices_at(caches[collider], seconds);
    return scaled(std::move(mesh), scales[collider]);
}

std::vector<JudgedModel> LoadedColliders::judged_at(double seconds, unsigned thread_count) const {
    std::vector<JudgedModel> result = judged;
    for (std::size_t c = 0; c < result.size(); ++c) {
        if (!deforms(c)) continue;
        result[c].mesh.vertices = vertices_at(caches[c], seconds);
        result[c].map = ExactMap::build(result[c].mesh, {.thread_count = thread_count});
    }
    return result;
}

LoadedColliders load_colliders(const Scene& scene, const fs::path& scene_path,
                               const std::vector<fs::path>& folders, unsigned thread_count) {
    LoadedColliders loaded;
    for (const SceneCollider& collider : scene.colliders) {
        const std::optional<fs::path> file = model_file(collider.model, scene_path, folders);
        if (file) loaded.files.push_back(*file);
        TriangleMesh mesh = load_model(collider, scene_path, file, scene.simulation.surface_collision);
        VertexCache& cache = loaded.caches.emplace_back();
        if (collider.cache) {
            const fs::path path = cache_path(*collider.cache, scene_path, folders);
            loaded.files.push_back(path);
            cache =
                read_vertex_cache(path, mesh, collider.cache->frames_per_second, collider.cache->animation);
            mesh.vertices = vertices_at(cache, 0);
        }
        const AnyMap map =
            made_as_scene_says(scene_path, "map", [&] { return build_map(mesh, scene.map, thread_count); });
        ExactMap judge = judge_of(map, mesh, thread_count);
        loaded.maps.emplace_back(map).surface = judge;
        loaded.judged.push_back({std::move(mesh), std::move(judge)});
        loaded.scales.push_back(collider.scale);
        loaded.names += (loaded.names.empty() ? "" : ", ") + model_name(collider.model);
        if (file && loaded.notice.empty()) loaded.notice = notice_beside(*file);
    }
    return loaded;
}
