#include "exact_map/build/border.hpp"

#include "directions/face_cone.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace echinus {

namespace {

/// An edge seen from its lower vertex: how many more faces run away from it than towards it.
struct HalfEdge {
    std::uint32_t higher;
    std::int32_t count; ///< a face has an edge but once, so that sums are at most kMostFaces
};

/// Adds up the half edges of one vertex by their other end, and appends what does not cancel.
void append_unbalanced(std::uint32_t lower, std::span<HalfEdge> half_edges, std::vector<BorderEdge>& border) {
    std::sort(half_edges.begin(), half_edges.end(),
              [](const HalfEdge& a, const HalfEdge& b) { return a.higher < b.higher; });
    for (std::size_t i = 0; i < half_edges.size();) {
        const std::uint32_t higher = half_edges[i].higher;
        std::int32_t sum = 0;
        for (; i < half_edges.size() && half_edges[i].higher == higher; ++i) sum += half_edges[i].count;
        if (sum != 0) border.push_back({lower, higher, sum});
    }
}

/// [vertex_count] the first vertex on the same lattice point.
std::vector<std::uint32_t> first_vertices_at(const std::vector<LatticePoint>& vertices) {
    const auto key = [&](std::uint32_t v) {
        return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z, v);
    };
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool repeated = i > 0 && vertices[order[i]] == vertices[order[i - 1]];
        first[order[i]] = repeated ? first[order[i - 1]] : order[i];
    }
    return first;
}

/// @param number  [vertex_count] of each vertex; vertices on one place have one number
std::vector<BorderEdge> unbalanced_edges(const LatticeMesh& lattice,
                                         const std::vector<std::uint32_t>& number) {
    const auto for_each_half_edge = [&](const auto& visit) {
        for (std::uint32_t face = 0; face < lattice.faces.size(); ++face) {
            if (is_collapsed(lattice.corners(face))) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = number[lattice.faces[face][k]];
                const std::uint32_t b = number[lattice.faces[face][(k + 1) % 3]];
                visit(std::min(a, b), HalfEdge{std::max(a, b), a < b ? 1 : -1});
            }
        }
    };
    std::vector<std::uint32_t> next(lattice.vertices.size() + 1);
    for_each_half_edge([&](std::uint32_t lower, HalfEdge) { ++next[lower + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<HalfEdge> half_edges(next.back());
    for_each_half_edge(
        [&](std::uint32_t lower, HalfEdge half_edge) { half_edges[next[lower]++] = half_edge; });
    // Now next[v] is where the half edges of v end.
    std::vector<BorderEdge> border;
    std::size_t first = 0;
    for (std::uint32_t lower = 0; lower < lattice.vertices.size(); ++lower) {
        append_unbalanced(lower, std::span(half_edges).subspan(first, next[lower] - first), border);
        first = next[lower];
    }
    return border;
}

} // namespace

std::vector<BorderEdge> find_border(const LatticeMesh& lattice) {
    return unbalanced_edges(lattice, first_vertices_at(lattice.vertices));
}

} // namespace echinus
