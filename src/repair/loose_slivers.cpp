#include "mesh/edges.hpp"
#include "mesh/faces.hpp"
#include "repair/edge_balance.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace echinus {

namespace {

/// Are the corners on one line, as far as float tells? The height over the longest side is then no more than
/// the corners are rounded.
bool has_no_area(const TriangleMesh& mesh, const Triangle& face) {
    constexpr double kRounding = 0x1p-23;
    double longest = 0, farthest = 0;
    std::array<Vec3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = Vec3d(mesh.vertices[face[k]]);
        const Vec3d& p = corners[k];
        farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, length(corners[(k + 1) % 3] - corners[k]));
    return length(cross(corners[1] - corners[0], corners[2] - corners[0])) <= kRounding * farthest * longest;
}

} // namespace

std::vector<std::uint32_t> find_loose_slivers(const TriangleMesh& mesh) {
    std::vector<bool> is_listed(mesh.faces.size());
    std::vector<std::vector<std::uint32_t>> slivers;
    for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
        if (is_balanced(uses)) return;
        for (const EdgeUse& use : uses) {
            if (is_listed[use.face] || !has_no_area(mesh, mesh.faces[use.face])) continue;
            is_listed[use.face] = true;
            slivers.push_back({use.face});
        }
    });
    if (slivers.empty()) return {};
    std::vector<std::uint32_t> loose = EdgeBalance(mesh).droppable(std::move(slivers));
    return loose.size() < mesh.faces.size() ? loose : std::vector<std::uint32_t>{};
}

} // namespace echinus
