#pragma once

#include "commands/verdict.hpp"

#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/mesh.hpp>
#include <echinus_scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The file from which a mesh of a scene comes, or nothing for a generated mesh. The file is searched in
/// `folders`, in the folder of the scene, in ../models relative to that, and then in models in the working
/// folder.
/// @throws echinus::Error Unreadable
std::optional<std::filesystem::path> model_file(const echinus::SceneModel& model,
                                                const std::filesystem::path& scene_path,
                                                std::vector<std::filesystem::path> folders);

/// The path of a collider's cache, which is searched in the same way.
/// @throws echinus::Error Unreadable
std::filesystem::path cache_path(const echinus::CacheFile& cache, const std::filesystem::path& scene_path,
                                 std::vector<std::filesystem::path> folders);

/// The mesh of a collider's model, read from its file or generated, and repaired by the scene's options.
/// @param file  the result of model_file()
/// @param may_be_open  whether an open mesh is accepted: colliding surfaces are kept apart even if they
/// enclose nothing
/// @throws echinus::Error as read_scene's parts do, and InvalidMesh if the mesh has to be closed and is not,
/// even after the repairs
echinus::TriangleMesh load_model(const echinus::SceneCollider& collider,
                                 const std::filesystem::path& scene_path,
                                 const std::optional<std::filesystem::path>& file, bool may_be_open);

/// Reads the meshes of a scene's cloth and bodies that come from files, and fills the bodies' surfaces.
/// @throws echinus::Error as read_mesh() does
echinus::ClothMeshes load_meshes(const echinus::Scene& scene, const std::filesystem::path& scene_path,
                                 const std::vector<std::filesystem::path>& folders);

/// The name of the model's file without folders, or of the generated shape.
std::string model_name(const echinus::SceneModel& model);

/// The file NOTICE in the model's folder, on the source of the models, to accompany published pictures; empty
/// if there is none.
/// @throws echinus::Error Unreadable
std::string notice_beside(const std::filesystem::path& model_file);

/// The colliders of a scene, with their models and the caches by which they deform.
struct LoadedColliders {
    std::vector<echinus::ColliderMap> maps;
    std::vector<JudgedModel> judged; ///< in their initial shape
    std::vector<echinus::Vec3d> scales;
    std::vector<echinus::VertexCache> caches; ///< empty for models that do not deform
    std::vector<std::filesystem::path> files; ///< the files from which models and caches come
    std::string names;                        ///< of the models
    std::string notice;                       ///< the notice of the first model that has one

    bool deforms(std::size_t collider) const { return caches[collider].samples != nullptr; }
    /// The mesh at a time, scaled but not moved.
    echinus::TriangleMesh mesh_at(std::size_t collider, double seconds) const;
    /// The references by which the colliders are judged at that time.
    std::vector<JudgedModel> judged_at(double seconds, unsigned thread_count) const;
};

/// @throws echinus::Error as the parts do; errors in options from the scene are reported as errors of the
/// scene
LoadedColliders load_colliders(const echinus::Scene& scene, const std::filesystem::path& scene_path,
                               const std::vector<std::filesystem::path>& folders, unsigned thread_count);

/// Reports errors in the options that a scene gives as errors of the scene.
/// @param key  the key that contains the options, for sentences that do not name it
template <typename Make>
auto made_as_scene_says(const std::filesystem::path& scene, const std::string& key, const Make& make) {
    try {
        return make();
    } catch (const echinus::Error& error) {
        if (error.code() != echinus::ErrorCode::InvalidOptions) throw;
        const std::string place = key.empty() ? "" : "\"" + key + "\": ";
        throw echinus::Error(echinus::ErrorCode::InvalidScene, scene.string() + ": " + place + error.what());
    }
}
