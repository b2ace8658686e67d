#pragma once

#include "commands/verdict.hpp"

#include <echinus/collider.hpp>
#include <echinus/error.hpp>
#include <echinus/scene.hpp>

#include <filesystem>
#include <string>
#include <vector>

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
    /// What judges them then.
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
