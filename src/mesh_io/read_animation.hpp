#pragma once

#include <echinus/collider.hpp>
#include <echinus/mesh.hpp>

#include <filesystem>
#include <string_view>

namespace echinus {

/// Do files with this ending have animations that read_animation() reads?
bool has_animations(const std::filesystem::path& path);

/// read_vertex_cache() of a file with a mesh and an animation.
/// @throws Error as read_vertex_cache() does
VertexCache read_animation(const std::filesystem::path& path, const TriangleMesh& mesh,
                           double frames_per_second, std::string_view animation);

} // namespace echinus
