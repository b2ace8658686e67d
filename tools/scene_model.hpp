#pragma once

#include <echinus/mesh.hpp>
#include <echinus/scene.hpp>

#include <filesystem>
#include <vector>

/// The mesh of a scene's model, read from its file or generated, and repaired as the scene wants it. A file
/// is looked up in `folders`, beside the scene, in ../models beside it, then in models in the working folder.
/// @throws echinus::Error as read_scene's parts do, and InvalidMesh when the mesh is not closed in the end
echinus::RepairedMesh load_model(const echinus::Scene& scene, const std::filesystem::path& scene_path,
                                 std::vector<std::filesystem::path> folders);
