#include "mesh/orientation.hpp"

#include "geometry/whole_numbers.hpp"

#include <array>
#include <limits>

namespace echinus {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The face beyond an edge, if there is just one.
struct Neighbour {
    std::uint32_t face = kNone;
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

} // namespace

Orientation find_orientation(std::span<const EdgeUse> edge_uses, std::size_t face_count) {
    const auto neighbours = find_neighbours(edge_uses, face_count);
    Orientation result{std::vector(face_count, kNone), std::vector<bool>(face_count), {}};
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t first = 0; first < face_count; ++first) {
        if (result.patch_of_face[first] != kNone) continue;
        const auto patch = kept_as<std::uint32_t>(result.is_orientable.size());
        result.is_orientable.push_back(true);
        result.patch_of_face[first] = patch;
        waiting.push_back(first);
        while (!waiting.empty()) {
            const std::uint32_t face = waiting.back();
            waiting.pop_back();
            for (const Neighbour& neighbour : neighbours[face]) {
                if (neighbour.face == kNone) continue;
                const bool is_turned = result.is_turned[face] != neighbour.runs_alike;
                if (result.patch_of_face[neighbour.face] == kNone) {
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

} // namespace echinus
