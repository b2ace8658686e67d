#include "exact_map/build/border_caps.hpp"

#include "directions/lattice.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace echinus {

namespace {

/// A face runs along it in this direction, and none against it.
struct OpenEdge {
    std::uint32_t from, to;
};

std::vector<OpenEdge> open_edges(std::span<const BorderEdge> border, std::size_t vertex_count) {
    std::vector<OpenEdge> result;
    for (const auto& [a, b, multiplicity] : border)
        if (std::max(a, b) < vertex_count)
            result.insert(result.end(), static_cast<std::size_t>(std::abs(std::int64_t{multiplicity})),
                          multiplicity > 0 ? OpenEdge{a, b} : OpenEdge{b, a});
    std::sort(result.begin(), result.end(),
              [](const OpenEdge& x, const OpenEdge& y) { return x.from < y.from; });
    return result;
}

/// Follows edges, each once, and calls visit(loop) wherever the path meets itself, with the vertices of the
/// loop that this closes.
template <typename Visit>
void for_each_loop(std::span<const OpenEdge> edges, std::size_t vertex_count, const Visit& visit) {
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> next(vertex_count, kNone), place_on_path(vertex_count, kNone), path;
    for (std::size_t e = edges.size(); e-- > 0;) next[edges[e].from] = kept_as<std::uint32_t>(e);
    const auto take_edge_from = [&](std::uint32_t vertex) -> const OpenEdge* {
        std::uint32_t& e = next[vertex];
        if (e == kNone || e == edges.size() || edges[e].from != vertex) return nullptr;
        return &edges[e++];
    };
    for (const OpenEdge& first : edges) {
        std::uint32_t vertex = first.from;
        while (true) {
            if (const std::uint32_t place = place_on_path[vertex]; place != kNone) {
                const std::span loop = std::span(path).subspan(place);
                visit(loop);
                for (const std::uint32_t v : loop) place_on_path[v] = kNone;
                path.resize(place);
            }
            place_on_path[vertex] = kept_as<std::uint32_t>(path.size());
            path.push_back(vertex);
            const OpenEdge* edge = take_edge_from(vertex);
            if (edge == nullptr) break;
            vertex = edge->to;
        }
        for (const std::uint32_t v : path) place_on_path[v] = kNone;
        path.clear();
    }
}

class LoopCap {
  public:
    LoopCap(std::span<const Vec3<std::int32_t>> vertices, std::vector<Triangle>& triangles)
        : vertices_(vertices), triangles_(triangles) {}

    /// Closes a path by the edge between its ends. The triangles run against it, as they close the surface.
    void operator()(std::span<const std::uint32_t> path) const {
        if (path.size() < 3) return;
        const std::size_t middle = path.size() / 2;
        add({path.front(), path.back(), path[middle]});
        (*this)(path.first(middle + 1));
        (*this)(path.subspan(middle));
    }

  private:
    void add(const Triangle& triangle) const {
        const LatticePoint a(vertices_[triangle[0]]), b(vertices_[triangle[1]]), c(vertices_[triangle[2]]);
        if (cross(b - a, c - a) != LatticePoint{}) triangles_.push_back(triangle);
    }

    std::span<const Vec3<std::int32_t>> vertices_;
    std::vector<Triangle>& triangles_;
};

} // namespace

std::vector<Triangle> cap_border(std::span<const BorderEdge> border,
                                 std::span<const Vec3<std::int32_t>> vertices) {
    std::vector<Triangle> triangles;
    for_each_loop(open_edges(border, vertices.size()), vertices.size(), LoopCap(vertices, triangles));
    return triangles;
}

} // namespace echinus
