#include "mesh/mesh_hash.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

std::uint64_t mesh_hash(std::span<const Vec3f> vertices, std::span<const Triangle> faces, const Vec3d& origin,
                        std::uint64_t seed) {
    if (origin != Vec3d{}) seed = XXH64(&origin, sizeof origin, seed);
    const std::uint64_t of_vertices = XXH64(vertices.data(), vertices.size_bytes(), seed);
    return XXH64(faces.data(), faces.size_bytes(), of_vertices);
}

std::uint64_t mesh_hash(const TriangleMesh& mesh, std::uint64_t seed) {
    return mesh_hash(mesh.vertices, mesh.faces, mesh.origin, seed);
}

} // namespace echinus
