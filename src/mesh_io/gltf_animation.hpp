#pragma once

#include "mesh_io/mesh_source.hpp"

#include <string_view>

namespace echinus {

/// Assimp (5.2.5) reads beyond its arrays where a skin, a morph target or an animation of a glTF file has
/// fewer numbers than what it belongs to (glTF 2.0, sections 3.7.2.2, 3.7.3 and 3.11). This compares the
/// counts.
/// @param json  brackets in it may be nested to any depth
/// @throws Error InvalidMesh; WrongFormat for a key in which letters are escaped, behind which such an array
/// could hide
void require_whole_gltf_animations(const MeshSource& source, std::string_view json);

/// What Assimp would take for other numbers than they are or leave out: weights, rotations and the like in
/// whole numbers, and more than four bones for a vertex.
/// @throws Error WrongFormat
void require_plain_gltf_animations(const MeshSource& source, std::string_view json);

} // namespace echinus
