#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>

namespace echinus {

/// XXH64 of a mesh's vertices and faces: identifies the source of a map.
/// @param seed  stands for what else the map depends on
std::uint64_t mesh_hash(const TriangleMesh& mesh, std::uint64_t seed);

} // namespace echinus
