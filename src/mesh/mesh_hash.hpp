#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <span>

namespace echinus {

/// XXH64 of a mesh's vertices and faces, and of its origin if it is not 0. It identifies the source of a map.
/// @param seed  represents everything else on which the map depends
std::uint64_t mesh_hash(const TriangleMesh& mesh, std::uint64_t seed);
std::uint64_t mesh_hash(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& origin,
                        std::uint64_t seed);

} // namespace echinus
