#include "mesh/edges.hpp"
#include "mesh/orientation.hpp"
#include "repair/repairs.hpp"

#include <utility>

namespace echinus {

std::size_t orient_faces(TriangleMesh& mesh) {
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    const Orientation orientation = find_orientation(edge_uses, mesh.faces.size());
    std::vector<bool> is_determined = orientation.is_orientable; // [patch_count]
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() == 2) return;
        for (const EdgeUse& use : uses) is_determined[orientation.patch_of_face[use.face]] = false;
    });
    std::vector<std::ptrdiff_t> majority(is_determined.size()); // of faces that run as the first of the patch
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        majority[orientation.patch_of_face[face]] += orientation.is_turned[face] ? -1 : 1;
    std::size_t turned_count = 0;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        const std::uint32_t patch = orientation.patch_of_face[face];
        if (!is_determined[patch] || orientation.is_turned[face] != (majority[patch] >= 0)) continue;
        std::swap(mesh.faces[face][1], mesh.faces[face][2]);
        ++turned_count;
    }
    return turned_count;
}

} // namespace echinus
