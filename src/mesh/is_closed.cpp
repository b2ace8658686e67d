#include "mesh/is_closed.hpp"

#include "geometry/arena.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

namespace {

/// A face's edge seen from its lower vertex: twice the other, and 1 more if the face runs towards it.
using HalfEdge = std::uint64_t;

/// Calls visit(lower vertex, half edge) for all edges of faces except those from a vertex to itself.
template <typename Visit>
void for_each_half_edge(std::span<const Triangle> faces, const Visit& visit) {
    const auto visit_edge = [&](std::uint32_t a, std::uint32_t b) {
        if (a != b) visit(std::min(a, b), packed<1>(std::max(a, b), a < b ? 1 : 0));
    };
    for (const auto& [a, b, c] : faces) {
        visit_edge(a, b);
        visit_edge(b, c);
        visit_edge(c, a);
    }
}

int direction(HalfEdge edge) {
    return static_cast<int>(2 * (edge & 1U)) - 1;
}

/// Compares all pairs without a branch, the fastest way for the few edges of a usual vertex.
template <std::size_t kCount>
bool are_balanced(const HalfEdge* edges) {
    std::array<std::uint32_t, kCount> ends;
    std::array<int, kCount> directions, sums{};
    for (std::size_t i = 0; i < kCount; ++i) {
        ends[i] = static_cast<std::uint32_t>(edges[i] >> 1);
        directions[i] = direction(edges[i]);
    }
    for (std::size_t k = 0; k < kCount; ++k)
        for (std::size_t i = 0; i < kCount; ++i) sums[i] += ends[i] == ends[k] ? directions[k] : 0;
    int unbalanced = 0;
    for (int sum : sums) unbalanced |= sum;
    return unbalanced == 0;
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

bool are_balanced(std::span<HalfEdge> edges) {
    switch (edges.size()) {
    case 0:
        return true;
    case 2:
        return are_balanced<2>(edges.data());
    case 4:
        return are_balanced<4>(edges.data());
    case 6:
        return are_balanced<6>(edges.data());
    case 8:
        return are_balanced<8>(edges.data());
    case 10:
        return are_balanced<10>(edges.data());
    case 12:
        return are_balanced<12>(edges.data());
    default:
        return many_are_balanced(edges);
    }
}

} // namespace

bool is_closed(std::span<const Triangle> faces, std::size_t vertex_count) {
    std::vector<std::uint32_t> ends(vertex_count + 1); // 32 bits number three half edges of kMostFaces faces
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
    // Now ends[v] is the end of v's half edges.
    std::uint32_t begin = 0;
    for (std::size_t lower = 0; lower < vertex_count; ++lower) {
        const std::span<HalfEdge> edges = std::span<HalfEdge>(half_edges).subspan(begin, ends[lower] - begin);
        begin = ends[lower];
        if (!are_balanced(edges)) return false;
    }
    return true;
}

} // namespace echinus
