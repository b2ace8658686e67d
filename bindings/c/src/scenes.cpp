// Simulations from scenes in JSON.

#include "border.hpp"
#include "handles.hpp"

#include <echinus/mesh_io.hpp>

#include <filesystem>
#include <vector>

namespace echinus::c {

namespace {

namespace fs = std::filesystem;

/// Reads or generates the meshes of a scene.
class Meshes {
  public:
    explicit Meshes(std::vector<fs::path> folders) : folders_(std::move(folders)) {}

    TriangleMesh operator()(const ModelFile& file) const { return read_mesh(find_model(file, folders_)); }
    TriangleMesh operator()(const auto& shape) const { return make_mesh(shape); }

    TriangleMesh model(const SceneCollider& collider) const {
        return repair(std::visit(*this, collider.model), collider.repair).mesh;
    }
    /// The cache of a collider; empty if it has none.
    VertexCache cache(const SceneCollider& collider, const TriangleMesh& model) const {
        if (!collider.cache) return {};
        return read_vertex_cache(find_cache(*collider.cache, folders_), model,
                                 collider.cache->frames_per_second, collider.cache->animation);
    }
    ClothMeshes deformables(const Scene& scene) const {
        ClothMeshes meshes;
        if (scene.mesh_cloth) {
            MeshAndEdges start = from_file(scene.mesh_cloth->mesh);
            meshes = {.mesh = std::move(start.mesh),
                      .rest_mesh = from_file(scene.mesh_cloth->rest_mesh).mesh,
                      .threads = std::move(start.edges)};
        }
        for (const SceneBody& body : scene.bodies) meshes.bodies.push_back(tetrahedra(body));
        return meshes;
    }

  private:
    /// The tetrahedra of a file, or those that fill its surface; empty for a generated shape, which is filled
    /// when the deformable is made.
    TetrahedralMesh tetrahedra(const SceneBody& body) const {
        const auto* file = std::get_if<ModelFile>(&body.mesh);
        if (file == nullptr) return {};
        const fs::path path = find_model(*file, folders_);
        if (body.element == 0) return read_tetrahedra(path).mesh;
        return fill_body(body, read_mesh(path));
    }

    MeshAndEdges from_file(const std::optional<SceneModel>& model) const {
        const auto* file = model ? std::get_if<ModelFile>(&*model) : nullptr;
        return file != nullptr ? read_mesh_and_edges(find_model(*file, folders_)) : MeshAndEdges{};
    }

    std::vector<fs::path> folders_;
};

std::vector<fs::path> folders_from(const char* const* folders, std::size_t count, const fs::path& of_scene) {
    std::vector<fs::path> result;
    for (const char* const& folder : values_at(folders, count, "folders"))
        result.push_back(utf8_path(&at(folder, "a folder")));
    result.push_back(of_scene);
    result.push_back(of_scene / ".." / "models");
    return result;
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : ".";
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_scene_read(const char* path, echinus_scene** scene) {
    if (scene != nullptr) *scene = nullptr;
    return guarded(__func__, [&] {
        at(scene, "scene");
        const std::filesystem::path file = utf8_path(&at(path, "path"));
        *scene = new echinus_scene{read_scene(file), folder_of(file)};
    });
}
echinus_status echinus_scene_parse(const char* json, const char* name, echinus_scene** scene) {
    if (scene != nullptr) *scene = nullptr;
    return guarded(__func__, [&] {
        at(scene, "scene");
        *scene =
            new echinus_scene{parse_scene(&at(json, "json"), &at(name, "name")), folder_of(utf8_path(name))};
    });
}

void echinus_scene_destroy(echinus_scene* scene) {
    delete scene;
}

uint32_t echinus_scene_frame_limit(const echinus_scene* scene) {
    return scene == nullptr ? 0 : scene->value.frame_limit;
}

echinus_status echinus_simulation_from_scene(const echinus_scene* scene, const char* const* folders,
                                             size_t folder_count, uint32_t thread_count,
                                             echinus_simulation** simulation) {
    return make(__func__, simulation, [&] {
        const Scene& description = at(scene, "scene").value;
        const Meshes meshes(folders_from(folders, folder_count, scene->folder));
        std::vector<ColliderMap> maps;
        std::vector<VertexCache> caches;
        for (const SceneCollider& collider : description.colliders) {
            TriangleMesh model = meshes.model(collider);
            caches.push_back(meshes.cache(collider, model));
            if (collider.cache) model.vertices = vertices_at(caches.back(), 0);
            maps.push_back(make_collider_map(description, model, thread_count));
        }
        return make_simulation(description, maps, meshes.deformables(description), caches);
    });
}
