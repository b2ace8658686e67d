#pragma once

#include <echinus/mesh.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// One face's use of one of its edges. Edge k of a face runs from corner k to the next.
struct EdgeUse {
    std::uint32_t low; ///< the smaller of the edge's two vertices
    std::uint32_t high;
    std::uint32_t face;
    std::uint8_t corner;
    bool ascending; ///< the face runs from low to high
};

/// All uses of all edges, sorted by edge and then by face, so that nothing depends on the order of a hash.
/// Faces with two equal corners have no boundary and contribute nothing.
/// @pre indices are in range
std::vector<EdgeUse> sorted_edge_uses(std::span<const Triangle> faces);
inline std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh) {
    return sorted_edge_uses(mesh.faces);
}

/// The uses of the edge between two vertices in the result of sorted_edge_uses().
std::span<const EdgeUse> uses_of_edge(std::span<const EdgeUse> all, std::uint32_t a, std::uint32_t b);

/// Equally many uses run along the edge in each direction: they cancel, the edge is no border.
bool is_balanced(std::span<const EdgeUse> uses_of_one_edge);

/// Calls visit(uses of one edge) for each edge in turn.
template <typename Visit>
void for_each_edge(std::span<const EdgeUse> all, Visit&& visit) {
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        while (end < all.size() && all[end].low == all[begin].low && all[end].high == all[begin].high) ++end;
        visit(all.subspan(begin, end - begin));
    }
}

} // namespace echinus
