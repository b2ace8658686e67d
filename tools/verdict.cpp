#include "verdict.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <vector>

using namespace echinus;

Verdict judge(std::span<const Vec3f> positions_world, const TriangleMesh& mesh, const Collider& collider,
              unsigned thread_count) {
    constexpr double kOutside = -1;
    std::vector<double> depths(positions_world.size(), kOutside);
    parallel_for(depths.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d point = collider.pose.to_local(Vec3d(positions_world[i])) * (1 / collider.scale);
            if (winding_number(mesh, point) > 0.5)
                depths[i] = unsigned_distance(mesh, point) * collider.scale;
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
