#include "mesh/mesh_hash.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

std::uint64_t mesh_hash(const TriangleMesh& mesh, std::uint64_t seed) {
    const std::uint64_t of_vertices = XXH64(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3f), seed);
    return XXH64(mesh.faces.data(), mesh.faces.size() * sizeof(Triangle), of_vertices);
}

} // namespace echinus
