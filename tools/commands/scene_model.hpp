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

/// Where a mesh of a scene comes from: the path of its file, or nothing for one that is generated. The file
/// is looked up in `folders`, beside the scene, in ../models beside it, then in models in the working folder.
/// @throws echinus::Error Unreadable
std::optional<std::filesystem::path> model_file(const echinus::SceneModel& model,
                                                const std::filesystem::path& scene_path,
                                                std::vector<std::filesystem::path> folders);

/// The path of a collider's cache, which is looked up in the same way.
/// @throws echinus::Error Unreadable
std::filesystem::path cache_path(const echinus::CacheFile& cache, const std::filesystem::path& scene_path,
                                 std::vector<std::filesystem::path> folders);

/// The mesh of a collider's model, read from its file or generated, and repaired by the scene's options.
/// @param file  what model_file() found
/// @param may_be_open  surfaces are kept apart whether they have an inside or not
/// @throws echinus::Error as read_scene's parts do, and InvalidMesh when the mesh is not closed in the end
/// and has to be
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
/// where there is none.
/// @throws echinus::Error Unreadable
std::string notice_beside(const std::filesystem::path& model_file);

/// The colliders of a scene, with their models and what makes them deform.
struct LoadedColliders {
    std::vector<echinus::ColliderMap> maps;
    std::vector<JudgedModel> judged; ///< as they begin
    std::vector<echinus::Vec3d> scales;
    std::vector<echinus::VertexCache> caches; ///< empty of those that do not deform
    std::vector<std::filesystem::path> files; ///< of those models and caches that come from files
    std::string names;                        ///< of the models
    std::string notice;                       ///< of the first model's source that has one

    bool deforms(std::size_t collider) const { return caches[collider].samples != nullptr; }
    /// Scaled, not moved.
    echinus::TriangleMesh mesh_at(std::size_t collider, double seconds) const;
    /// The references by which the colliders are judged at that time.
    std::vector<JudgedModel> judged_at(double seconds, unsigned thread_count) const;
};

/// @throws echinus::Error as the parts do; of options that a key of the scene gives as errors of the scene
LoadedColliders load_colliders(const echinus::Scene& scene, const std::filesystem::path& scene_path,
                               const std::vector<std::filesystem::path>& folders, unsigned thread_count);

/// Reports errors in the options that a scene gives as errors of the scene.
/// @param key  whose options they are, where their sentences do not say so
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
