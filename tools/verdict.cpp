#include "verdict.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <utility>
#include <vector>

using namespace echinus;

TriangleMesh scaled(TriangleMesh mesh, const Vec3d& scale) {
    for (Vec3f& v : mesh.vertices) v = Vec3f(Vec3d(v.x * scale.x, v.y * scale.y, v.z * scale.z));
    if (scale.x * scale.y * scale.z < 0)
        for (Triangle& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

Verdict judge(std::span<const Vec3f> positions_world, const TriangleMesh& mesh, const Collider& collider,
              unsigned thread_count) {
    const TriangleMesh solid = scaled(mesh, collider.scale);
    constexpr double kOutside = -1;
    std::vector<double> depths(positions_world.size(), kOutside);
    parallel_for(depths.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d point = collider.pose.to_local(Vec3d(positions_world[i]));
            if (winding_number(solid, point) > 0.5) depths[i] = unsigned_distance(solid, point);
        }
    });
    Verdict verdict;
    for (const double depth : depths) {
        if (depth == kOutside) continue;
        ++verdict.inside_count;
        verdict.deepest = std::max(verdict.deepest, depth);
    }
    return verdict;
}
