#pragma once

#include "mesh_io/mesh_source.hpp"

#include <cstddef>
#include <string_view>

/// Checks that protect Assimp. Its readers are recursive and run out of stack on deeply nested files (version
/// 5.2.5: from about 10 000 nodes in a chain on); they accept files shorter than declared, and compressed
/// positions as plain ones; and they replace a vertex missing from a 3DS file by another one, or drop the
/// face in glTF.
namespace echinus {

/// Nodes that have children of their own: in the worst case they form one chain.
inline constexpr std::size_t kMaxParentNodes = 4096;
inline constexpr std::size_t kMaxJsonDepth = 256;

/// @param beginning  the first bytes of a file, or all of it
/// @throws Error WrongFormat when no file of the kind begins like this
void require_beginning_of_gltf(const MeshSource& beginning);
void require_beginning_of_glb(const MeshSource& beginning);
void require_beginning_of_3ds(const MeshSource& beginning);

/// @throws Error WrongFormat when the file does not begin like one of its kind or has compressed positions;
/// Damaged when it is shorter than its head says, or is nested too deeply to be read; InvalidMesh when a face
/// refers to a vertex that is not there, or an array of a glTF file's skins, morph targets and animations is
/// shorter than what it belongs to
void require_readable_gltf(const MeshSource& source);
void require_readable_glb(const MeshSource& source);
void require_readable_3ds(const MeshSource& source);

/// The text of a glTF or GLB file. @throws Error Damaged when the file ends before it
std::string_view json_of(const MeshSource& gltf);

} // namespace echinus
