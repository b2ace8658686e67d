#include "mesh/edges.hpp"
#include "repair/edge_balance.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

// A quadrilateral a b c d that a modeller filled twice, once along the diagonal a c and once along b d,
// leaves the four faces of a flat tetrahedron on the surface:
//
//      d ------ c        d ------ c
//      |      / |        | \      |
//      |    /   |   and  |   \    |      with the rest of the surface along a b, b c, c d, d a
//      |  /     |        |     \  |
//      a ------ b        a ------ b
//
// Its edges identify it: each diagonal has exactly the two faces of its own patch, each side has a face of
// either patch and at least one face of the surrounding surface. (A separate tetrahedron has two faces at
// every edge and is left alone.) A face has at most one such patch, and a quadrilateral at most two. Dropping
// one patch leaves the surface as its author meant it: the one without which the edges are balanced better.
// Where the common side of two solids is divided along either diagonal, all edges are balanced, and both
// patches stay.

namespace echinus {

namespace {

using Faces = std::vector<std::uint32_t>;

struct Patch {
    std::array<std::uint32_t, 4> corners{}; // ascending
    Faces faces;                            // two, ascending
};

std::uint32_t corner_opposite(const TriangleMesh& mesh, const EdgeUse& use) {
    return mesh.faces[use.face][(use.corner + 2U) % 3];
}

/// The patch of the two faces at an edge, if the edge may be the diagonal of a doubled one.
std::optional<Patch> patch_along(const TriangleMesh& mesh, std::span<const EdgeUse> all,
                                 std::span<const EdgeUse> diagonal) {
    if (diagonal.size() != 2) return std::nullopt;
    const std::array<std::uint32_t, 2> ends{diagonal[0].low, diagonal[0].high};
    const std::array<std::uint32_t, 2> tips{corner_opposite(mesh, diagonal[0]),
                                            corner_opposite(mesh, diagonal[1])};
    if (tips[0] == tips[1]) return std::nullopt;
    for (const std::uint32_t end : ends)
        for (const std::uint32_t tip : tips)
            if (uses_of_edge(all, end, tip).size() < 3) return std::nullopt;

    Patch patch{{ends[0], ends[1], tips[0], tips[1]}, {diagonal[0].face, diagonal[1].face}};
    std::sort(patch.corners.begin(), patch.corners.end());
    return patch;
}

} // namespace

std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh) {
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    std::vector<Patch> patches;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (auto patch = patch_along(mesh, edge_uses, uses)) patches.push_back(std::move(*patch));
    });
    if (patches.empty()) return {};
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
        return std::tie(a.corners, a.faces) < std::tie(b.corners, b.faces);
    });
    EdgeBalance balance(mesh);
    std::vector<Faces> doubled; // of equally good patches the later one
    for (std::size_t i = 1; i < patches.size(); ++i) {
        if (patches[i].corners != patches[i - 1].corners) continue;
        const bool first_is_better =
            balance.gain_without(patches[i].faces) >= balance.gain_without(patches[i - 1].faces);
        doubled.push_back(patches[first_is_better ? i : i - 1].faces);
    }
    return balance.droppable(std::move(doubled));
}

} // namespace echinus
