#include "mesh/is_closed.hpp"

#include "geometry/arena.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace echinus {

namespace {

/// A face's edge seen from its lower vertex: twice the other, and 1 more if the face runs towards it.
using HalfEdge = std::uint64_t;

/// Calls visit(lower vertex, half edge) for all edges of faces but those from a vertex to itself.
template <typename Visit>
void for_each_half_edge(std::span<const Triangle> faces, const Visit& visit) {
    for (const Triangle& face : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = face[k], b = face[k == 2 ? 0 : k + 1];
            if (a != b) visit(std::min(a, b), HalfEdge{std::max(a, b)} << 1 | (a < b ? 1 : 0));
        }
}

int direction(HalfEdge edge) {
    return (edge & 1U) != 0 ? 1 : -1;
}

/// By comparing all pairs, without a branch: the few edges of a usual vertex are told apart fastest so.
bool few_are_balanced(std::span<const HalfEdge> edges) {
    bool balanced = true;
    for (HalfEdge edge : edges) {
        int sum = 0;
        for (HalfEdge other : edges) sum += (other >> 1) == (edge >> 1) ? direction(other) : 0;
        balanced &= sum == 0;
    }
    return balanced;
}

bool many_are_balanced(std::span<HalfEdge> edges) {
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        const HalfEdge end = edges[i] >> 1;
        int sum = 0;
        for (; i < edges.size() && edges[i] >> 1 == end; ++i) sum += direction(edges[i]);
        if (sum != 0) return false;
    }
    return true;
}

} // namespace

bool is_closed(std::span<const Triangle> faces, std::size_t vertex_count) {
    constexpr std::size_t kFew = 24;
    std::vector<std::uint32_t> ends(vertex_count + 1);
    for_each_half_edge(faces, [&](std::uint32_t lower, HalfEdge) { ++ends[lower]; });
    std::uint32_t end = 0;
    for (std::uint32_t& offset : ends) {
        const std::uint32_t count = offset;
        offset = end;
        end += count;
    }
    Arena<HalfEdge> half_edges;
    half_edges.reset(end);
    for_each_half_edge(faces, [&](std::uint32_t lower, HalfEdge edge) { half_edges[ends[lower]++] = edge; });
    // Now ends[v] is where the half edges of v end.
    std::uint32_t begin = 0;
    for (std::size_t lower = 0; lower < vertex_count; ++lower) {
        const std::span<HalfEdge> edges = std::span<HalfEdge>(half_edges).subspan(begin, ends[lower] - begin);
        begin = ends[lower];
        if (!(edges.size() <= kFew ? few_are_balanced(edges) : many_are_balanced(edges))) return false;
    }
    return true;
}

} // namespace echinus
