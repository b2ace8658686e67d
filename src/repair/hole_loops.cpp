#include "repair/hole_loops.hpp"

#include "mesh/edges.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace echinus {

namespace {

/// The half edges that are missing for every edge to be balanced, by the vertex where they start.
class MissingHalfEdges {
  public:
    explicit MissingHalfEdges(const TriangleMesh& mesh) : taken_(mesh.vertices.size() + 1) {
        struct HalfEdge {
            std::uint32_t from, to;
        };
        std::vector<HalfEdge> missing;
        for_each_edge(sorted_edge_uses(mesh), [&](std::span<const EdgeUse> uses) {
            std::ptrdiff_t surplus = 0;
            for (const EdgeUse& use : uses) surplus += use.ascending ? 1 : -1;
            const auto [low, high] = std::pair(uses[0].low, uses[0].high);
            for (; surplus > 0; --surplus) missing.push_back({high, low});
            for (; surplus < 0; ++surplus) missing.push_back({low, high});
        });
        std::stable_sort(missing.begin(), missing.end(),
                         [](const HalfEdge& a, const HalfEdge& b) { return a.from < b.from; });
        ends_.reserve(missing.size());
        std::vector<std::size_t> count(mesh.vertices.size() + 1);
        for (const HalfEdge& edge : missing) {
            ends_.push_back(edge.to);
            ++count[edge.from + 1];
        }
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) taken_[v + 1] = taken_[v] + count[v + 1];
        end_ = {taken_.begin() + 1, taken_.end()};
    }

    bool starts_at(std::uint32_t vertex) const { return taken_[vertex] < end_[vertex]; }

    /// Where the next half edge from a vertex leads. @pre starts_at(vertex)
    std::uint32_t take(std::uint32_t vertex) { return ends_[taken_[vertex]++]; }

  private:
    std::vector<std::uint32_t> ends_; ///< grouped by the start
    std::vector<std::size_t> taken_;  ///< [vertex_count + 1] the first in ends_ that is not taken yet
    std::vector<std::size_t> end_;    ///< [vertex_count]
};

} // namespace

std::vector<HoleLoop> find_hole_loops(const TriangleMesh& mesh) {
    constexpr std::size_t kNotOnPath = std::numeric_limits<std::size_t>::max();
    MissingHalfEdges edges(mesh);
    std::vector<std::size_t> place_on_path(mesh.vertices.size(), kNotOnPath);
    std::vector<HoleLoop> loops;
    for (std::uint32_t start = 0; start < mesh.vertices.size(); ++start) {
        std::vector<std::uint32_t> path{start};
        place_on_path[start] = 0;
        // As many half edges end at a vertex as start there, so the path only ends where it began.
        while (edges.starts_at(path.back())) {
            const std::uint32_t next = edges.take(path.back());
            if (place_on_path[next] == kNotOnPath) {
                place_on_path[next] = path.size();
                path.push_back(next);
                continue;
            }
            const auto first = path.begin() + static_cast<std::ptrdiff_t>(place_on_path[next]);
            loops.emplace_back(first, path.end());
            for (auto passed = first + 1; passed != path.end(); ++passed) place_on_path[*passed] = kNotOnPath;
            path.erase(first + 1, path.end());
        }
        place_on_path[start] = kNotOnPath;
    }
    return loops;
}

} // namespace echinus
