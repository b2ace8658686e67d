#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <span>

namespace echinus {

/// XXH64 of a mesh's vertices and faces: identifies the source of a map.
/// @param seed  covers everything else that the map depends on
std::uint64_t mesh_hash(const TriangleMesh& mesh, std::uint64_t seed);
std::uint64_t mesh_hash(std::span<const Vec3f> vertices, std::span<const Triangle> faces, std::uint64_t seed);

} // namespace echinus
