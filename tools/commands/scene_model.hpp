#pragma once

#include <echinus/mesh.hpp>
#include <echinus/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Where a scene's model comes from: the path of its file, or nothing for one that is generated. The file is
/// looked up in `folders`, beside the scene, in ../models beside it, then in models in the working folder.
/// @throws echinus::Error Unreadable
std::optional<std::filesystem::path> model_file(const echinus::Scene& scene,
                                                const std::filesystem::path& scene_path,
                                                std::vector<std::filesystem::path> folders);

/// The mesh of a scene's model, read from its file or generated, and repaired as the scene wants it.
/// @param file  what model_file() found
/// @throws echinus::Error as read_scene's parts do, and InvalidMesh when the mesh is not closed in the end
echinus::RepairedMesh load_model(const echinus::Scene& scene, const std::filesystem::path& scene_path,
                                 const std::optional<std::filesystem::path>& file);

/// The model's file without folders, or what shape is generated.
std::string model_name(const echinus::Scene& scene);

/// What a file NOTICE in the model's folder says of where the models come from, for those who hand on
/// pictures of them; empty where there is none.
/// @throws echinus::Error Unreadable
std::string notice_beside(const std::filesystem::path& model_file);
