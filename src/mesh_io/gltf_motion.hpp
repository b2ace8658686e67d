#pragma once

#include "mesh_io/gltf_file.hpp"
#include "mesh_io/scene_file.hpp"

#include <cstddef>
#include <vector>

namespace echinus {

/// The animations of a glTF file (glTF 2.0, section 3.11). Of splines the values at the keys are kept.
/// @param numbers  of the file's nodes in scene.nodes; channels of nodes beyond are left out
/// @throws Error InvalidMesh
std::vector<SceneAnimation> read_gltf_animations(GltfFile& file, const SceneFile& scene,
                                                 const std::vector<std::size_t>& numbers);

} // namespace echinus
