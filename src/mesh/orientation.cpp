#include "mesh/orientation.hpp"

#include "geometry/whole_numbers.hpp"

#include <array>
#include <limits>
#include <utility>

namespace echinus {

namespace {

constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

/// The face beyond an edge, if there is just one.
struct Neighbour {
    std::uint32_t face = kNoFace;
    bool runs_alike = false; ///< both run along the edge the same way, so that one of them is turned
};

std::vector<std::array<Neighbour, 3>> find_neighbours(std::span<const EdgeUse> edge_uses,
                                                      std::size_t face_count) {
    std::vector<std::array<Neighbour, 3>> neighbours(face_count);
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        if (uses.size() != 2) return;
        const bool runs_alike = uses[0].ascending == uses[1].ascending;
        neighbours[uses[0].face][uses[0].corner] = {uses[1].face, runs_alike};
        neighbours[uses[1].face][uses[1].corner] = {uses[0].face, runs_alike};
    });
    return neighbours;
}

/// Finds the patches, how their faces run, and which of them are orientable.
Orientation find_patches(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    const auto neighbours = find_neighbours(edge_uses, face_count);
    Orientation result{std::vector(face_count, kNoFace), std::vector<bool>(face_count), {}, {}};
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t first = 0; first < face_count; ++first) {
        if (result.patch_of_face[first] != kNoFace) continue;
        const auto patch = kept_as<std::uint32_t>(result.is_orientable.size());
        result.is_orientable.push_back(true);
        result.patch_of_face[first] = patch;
        waiting.push_back(first);
        while (!waiting.empty()) {
            const std::uint32_t face = waiting.back();
            waiting.pop_back();
            for (const Neighbour& neighbour : neighbours[face]) {
                if (neighbour.face == kNoFace) continue;
                const bool is_turned = result.is_turned[face] != neighbour.runs_alike;
                if (result.patch_of_face[neighbour.face] == kNoFace) {
                    result.patch_of_face[neighbour.face] = patch;
                    result.is_turned[neighbour.face] = is_turned;
                    waiting.push_back(neighbour.face);
                } else if (result.is_turned[neighbour.face] != is_turned) {
                    result.is_orientable[patch] = false;
                }
            }
        }
    }
    return result;
}

} // namespace

Orientation find_orientation(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    Orientation result = find_patches(edge_uses, face_count);
    result.is_closed =
        find_closed_sets(edge_uses, result.patch_of_face, result.is_orientable.size(), result.is_turned);
    for (std::size_t patch = 0; patch < result.is_closed.size(); ++patch)
        result.is_closed[patch] = result.is_closed[patch] && result.is_orientable[patch];
    return result;
}

std::vector<bool> find_closed_sets(std::span<const EdgeUse> edge_uses,
                                   std::span<const std::uint32_t> set_of_face, std::size_t set_count,
                                   const std::vector<bool>& is_turned) {
    std::vector<bool> is_closed(set_count, true);
    std::vector<std::int64_t> balance(set_count); // of the set's faces along one edge
    for_each_edge(edge_uses, [&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses) {
            const bool is_ascending = use.ascending != (!is_turned.empty() && is_turned[use.face]);
            balance[set_of_face[use.face]] += is_ascending ? 1 : -1;
        }
        for (const EdgeUse& use : uses) {
            const std::uint32_t set = set_of_face[use.face];
            if (std::exchange(balance[set], 0) != 0) is_closed[set] = false;
        }
    });
    return is_closed;
}

} // namespace echinus
