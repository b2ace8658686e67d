#include "commands/scene_model.hpp"

#include "commands/descriptions.hpp"
#include "files/read_file.hpp"
#include "files/text.hpp"
#include "input_file.hpp"

#include <echinus/error.hpp>
#include <echinus/mesh_io.hpp>

#include <optional>
#include <string>
#include <utility>
#include <variant>

using namespace echinus;
namespace fs = std::filesystem;

namespace {

struct MeshOfModel {
    const fs::path& scene_path;
    const std::optional<fs::path>& file;

    TriangleMesh operator()(const ModelFile&) const { return read_mesh(file.value()); }
    TriangleMesh operator()(const auto& shape) const {
        try {
            return make_mesh(shape);
        } catch (const Error& error) {
            throw Error(ErrorCode::InvalidScene, scene_path.string() + ": \"model\": " + error.what());
        }
    }
};

struct NameOfModel {
    std::string operator()(const ModelFile& file) const {
        return echinus::utf8_path(file.name).filename().string();
    }
    std::string operator()(const TorusModel&) const { return "torus"; }
    std::string operator()(const SphereModel&) const { return "sphere"; }
    std::string operator()(const BoxModel&) const { return "box"; }
};

/// Refuses an open mesh: a hole would let particles in, and behind it the inside is undefined.
/// @param as_read  the mesh before the repairs that the scene names
void require_closed(const TriangleMesh& mesh, const TriangleMesh& as_read, const std::string& name) {
    const MeshReport report = inspect(mesh);
    if (report.closed) return;
    throw Error(
        ErrorCode::InvalidMesh,
        name + ": " +
            refusal_of_open_mesh(
                as_read, report,
                R"("repair": ["seams", "duplicate_faces", "doubled_patches", "slivers", "orientation"] in the scene)",
                R"(, or with "small_holes" or "sheets" in the scene's "repair")"));
}

} // namespace

std::string model_name(const SceneModel& model) {
    return std::visit(NameOfModel{}, model);
}

std::string notice_beside(const fs::path& model_file) {
    const fs::path path = model_file.parent_path() / "NOTICE";
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return {};
    const std::vector<std::byte> notice = read_file(path);
    return {reinterpret_cast<const char*>(notice.data()), notice.size()};
}

namespace {

/// The folders in which files of a scene are searched, beginning with those that the caller names.
std::vector<fs::path> with_folders_of(const fs::path& scene_path, std::vector<fs::path> folders) {
    folders.push_back(scene_path.parent_path().empty() ? "." : scene_path.parent_path());
    folders.push_back(scene_path.parent_path() / ".." / "models");
    folders.emplace_back("models");
    return folders;
}

} // namespace

std::optional<fs::path> model_file(const SceneModel& model, const fs::path& scene_path,
                                   std::vector<fs::path> folders) {
    const auto* file = std::get_if<ModelFile>(&model);
    if (file == nullptr) return std::nullopt;
    return naming_file(scene_path.string(), ErrorCode::Unreadable,
                       [&] { return find_model(*file, with_folders_of(scene_path, std::move(folders))); });
}

fs::path cache_path(const CacheFile& cache, const fs::path& scene_path, std::vector<fs::path> folders) {
    return naming_file(scene_path.string(), ErrorCode::Unreadable,
                       [&] { return find_cache(cache, with_folders_of(scene_path, std::move(folders))); });
}

TriangleMesh load_model(const SceneCollider& collider, const fs::path& scene_path,
                        const std::optional<fs::path>& file, bool may_be_open) {
    const TriangleMesh as_read = std::visit(MeshOfModel{scene_path, file}, collider.model);
    TriangleMesh mesh = repair(as_read, collider.repair).mesh;
    if (!may_be_open)
        require_closed(mesh, as_read, scene_path.string() + (file ? ": " + file->string() : ""));
    return mesh;
}

namespace {

/// The tetrahedra of a file, or those that fill its surface. Generated shapes are filled when the deformable
/// is made.
TetrahedralMesh load_body(const SceneBody& body, const fs::path& scene_path,
                          const std::vector<fs::path>& folders) {
    const std::optional<fs::path> file = model_file(body.mesh, scene_path, folders);
    if (!file) return {};
    if (body.element == 0) return read_tetrahedra(*file).mesh;
    return naming_file(file->string(), ErrorCode::InvalidMesh,
                       [&] { return fill_body(body, read_mesh(*file)); });
}

} // namespace

ClothMeshes load_meshes(const Scene& scene, const fs::path& scene_path,
                        const std::vector<fs::path>& folders) {
    const auto read = [&](const std::optional<SceneModel>& model) {
        const std::optional<fs::path> file = model ? model_file(*model, scene_path, folders) : std::nullopt;
        return file ? read_mesh_and_edges(*file) : MeshAndEdges{};
    };
    ClothMeshes meshes;
    if (scene.has_cloth && scene.mesh_cloth) {
        MeshAndEdges start = read(scene.mesh_cloth->mesh);
        meshes = {.mesh = std::move(start.mesh),
                  .rest_mesh = read(scene.mesh_cloth->rest_mesh).mesh,
                  .threads = std::move(start.edges)};
    }
    for (const SceneBody& body : scene.bodies) meshes.bodies.push_back(load_body(body, scene_path, folders));
    return meshes;
}

namespace {

/// The exact map that judges a model: that of the scene, or one built for this purpose.
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
        TriangleMesh mesh = load_model(collider, scene_path, file, scene.simulation.surfaces_collide());
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
