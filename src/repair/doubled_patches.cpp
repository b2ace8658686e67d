#include "mesh/edges.hpp"
#include "repair/repairs.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

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
// one patch leaves the surface as its author meant it. The wrong patch is the one with more sides along which
// it runs the same way as the surrounding surface.

namespace echinus {

namespace {

struct Patch {
    std::array<std::uint32_t, 4> corners{}; // ascending
    std::array<std::uint32_t, 2> faces{};   // ascending
    std::size_t clash_count = 0;            // uses of its edges that run the same way as a neighbour's
};

std::uint32_t corner_opposite(const TriangleMesh& mesh, const EdgeUse& use) {
    return mesh.faces[use.face][(use.corner + 2U) % 3];
}

bool lies_within(const Triangle& face, const std::array<std::uint32_t, 4>& corners) {
    return std::all_of(face.begin(), face.end(), [&](std::uint32_t vertex) {
        return std::binary_search(corners.begin(), corners.end(), vertex);
    });
}

/// How many faces of the surrounding surface run along this side of the patch the same way as the patch does.
std::size_t count_clashes(const TriangleMesh& mesh, std::span<const EdgeUse> side, const Patch& patch) {
    const auto own = std::find_if(side.begin(), side.end(), [&](const EdgeUse& use) {
        return use.face == patch.faces[0] || use.face == patch.faces[1];
    });
    return static_cast<std::size_t>(std::count_if(side.begin(), side.end(), [&](const EdgeUse& use) {
        return use.ascending == own->ascending && !lies_within(mesh.faces[use.face], patch.corners);
    }));
}

/// The patch of the two faces at an edge, if the edge may be the diagonal of a doubled one.
std::optional<Patch> patch_along(const TriangleMesh& mesh, std::span<const EdgeUse> all,
                                 std::span<const EdgeUse> diagonal) {
    if (diagonal.size() != 2) return std::nullopt;
    const std::array<std::uint32_t, 2> ends{diagonal[0].low, diagonal[0].high};
    const std::array<std::uint32_t, 2> tips{corner_opposite(mesh, diagonal[0]),
                                            corner_opposite(mesh, diagonal[1])};
    if (tips[0] == tips[1]) return std::nullopt;

    Patch patch{{ends[0], ends[1], tips[0], tips[1]}, {diagonal[0].face, diagonal[1].face}, 0};
    std::sort(patch.corners.begin(), patch.corners.end());
    if (!is_balanced(diagonal)) patch.clash_count = 1;
    for (std::uint32_t end : ends)
        for (std::uint32_t tip : tips) {
            const std::span<const EdgeUse> side = uses_of_edge(all, end, tip);
            if (side.size() < 3) return std::nullopt;
            patch.clash_count += count_clashes(mesh, side, patch);
        }
    return patch;
}

} // namespace

std::vector<std::uint32_t> find_doubled_patch_faces(const TriangleMesh& mesh) {
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    std::vector<Patch> patches;
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (const auto patch = patch_along(mesh, edge_uses, uses)) patches.push_back(*patch);
    });
    // The better patch of each quadrilateral comes first.
    std::sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
        return std::tie(a.corners, a.clash_count, a.faces) < std::tie(b.corners, b.clash_count, b.faces);
    });
    std::vector<std::uint32_t> dropped;
    for (std::size_t i = 1; i < patches.size(); ++i)
        if (patches[i].corners == patches[i - 1].corners)
            dropped.insert(dropped.end(), patches[i].faces.begin(), patches[i].faces.end());
    std::sort(dropped.begin(), dropped.end());
    return dropped;
}

} // namespace echinus
