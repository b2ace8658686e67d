#include "mesh/edges.hpp"
#include "mesh/orientation.hpp"
#include "repair/repairs.hpp"

#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// How many more faces run one way along an edge than the other, of all edges together.
std::size_t total_imbalance(const std::vector<EdgeUse>& edge_uses) {
    std::size_t total = 0;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        std::ptrdiff_t sum = 0;
        for (const EdgeUse& use : uses) sum += use.ascending ? 1 : -1;
        total += static_cast<std::size_t>(std::abs(sum));
    });
    return total;
}

} // namespace

std::size_t orient_faces(TriangleMesh& mesh) {
    std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    const Orientation orientation = find_orientation(edge_uses, mesh.faces.size());
    // Of each patch, how many more faces run as its first one does than the other way.
    std::vector<std::ptrdiff_t> majority(orientation.is_closed.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        majority[orientation.patch_of_face[face]] += orientation.is_turned[face] ? -1 : 1;
    const auto is_to_turn = [&](std::uint32_t face) {
        const std::uint32_t patch = orientation.patch_of_face[face];
        return orientation.is_closed[patch] && orientation.is_turned[face] == (majority[patch] >= 0);
    };
    // Faces of two patches may happen to balance each other. Only a smaller sum of imbalances counts, so that
    // repair() comes to an end.
    const std::size_t before = total_imbalance(edge_uses);
    for (EdgeUse& use : edge_uses) use.ascending = use.ascending != is_to_turn(use.face);
    if (total_imbalance(edge_uses) >= before) return 0;
    std::size_t turned_count = 0;
    for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
        if (!is_to_turn(face)) continue;
        std::swap(mesh.faces[face][1], mesh.faces[face][2]);
        ++turned_count;
    }
    return turned_count;
}

} // namespace echinus
