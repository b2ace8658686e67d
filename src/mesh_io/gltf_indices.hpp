#pragma once

#include "mesh_io/mesh_source.hpp"

#include <string_view>

namespace echinus {

/// Assimp drops the faces of a glTF file that refer to missing vertices. This compares the indices of every
/// primitive with the number of its positions (glTF 2.0, sections 3.6 and 3.7.2), whether they lie in the
/// binary part of a GLB file, in the text as base64 or in a separate file. Sparse accessors, escaped letters
/// in keys, and malformed input are left to Assimp.
/// @param json    brackets in it may be nested to any depth
/// @param binary  the content of a GLB file's binary chunk
/// @throws Error InvalidMesh
void require_gltf_vertices(const MeshSource& source, std::string_view json, std::string_view binary);

} // namespace echinus
