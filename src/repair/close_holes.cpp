#include "mesh/faces.hpp"
#include "repair/repairs.hpp"

#include <echinus/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// The vertices around a hole, at least three, each once, in the direction in which the faces that fill it
/// run.
using HoleLoop = std::vector<std::uint32_t>;

/// The half edges that are missing for every edge to be balanced, grouped by the vertex at which they start.
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

    /// Takes the next half edge from a vertex and returns its end. @pre starts_at(vertex)
    std::uint32_t take(std::uint32_t vertex) { return ends_[taken_[vertex]++]; }

  private:
    std::vector<std::uint32_t> ends_; ///< ends of half edges, grouped by their start
    std::vector<std::size_t> taken_;  ///< [vertex_count + 1] in ends_, each vertex's first one not yet taken
    std::vector<std::size_t> end_;    ///< [vertex_count] index in ends_ after each vertex's last half edge
};

/// The edges along which more faces run in one direction than in the other, as loops. They always form loops,
/// since the edges of every single face do. Loops that touch at a vertex are separated there; if they touch
/// at several vertices, one of the possible separations is chosen. The same mesh always gives the same loops.
/// Time O(n log n).
/// @pre indices are in range
std::vector<HoleLoop> find_hole_loops(const TriangleMesh& mesh) {
    constexpr std::size_t kNotOnPath = std::numeric_limits<std::size_t>::max();
    MissingHalfEdges edges(mesh);
    std::vector<std::size_t> place_on_path(mesh.vertices.size(), kNotOnPath);
    std::vector<HoleLoop> loops;
    for (std::uint32_t start = 0; start < mesh.vertices.size(); ++start) {
        std::vector<std::uint32_t> path{start};
        place_on_path[start] = 0;
        // As many half edges end at a vertex as start there, so the path can end only where it began.
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

double area_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return length(cross(b - a, c - a)) / 2;
}

double area_of(const TriangleMesh& mesh, const Triangle& face) {
    return area_of(Vec3d(mesh.vertices[face[0]]), Vec3d(mesh.vertices[face[1]]),
                   Vec3d(mesh.vertices[face[2]]));
}

/// The triangles of least total area that fill a loop, found by dynamic programming over its chords: Barequet
/// and Sharir, "Filling Gaps in the Boundary of a Polyhedron" (1995). Time O(n^3), memory O(n^2).
///
/// Of fillings with equal area, of which a flat hole has many, the one with the shortest chords is chosen.
/// Chords that are already edges of the mesh and triangles without area are used only if there is no
/// alternative.
class LeastFilling {
  public:
    LeastFilling(const TriangleMesh& mesh, std::span<const EdgeUse> edge_uses, const HoleLoop& loop)
        : loop_(loop), count_(loop.size()), best_(count_ * count_), split_(count_ * count_) {
        double perimeter = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            points_.emplace_back(mesh.vertices[loop[i]]);
            perimeter += length(Vec3d(mesh.vertices[loop[(i + 1) % count_]]) - points_[i]);
        }
        last_resort_ = 1e3 * perimeter * perimeter;
        for (std::size_t reach = 2; reach < count_; ++reach)
            for (std::size_t i = 0; i + reach < count_; ++i) {
                find_best_split(i, i + reach);
                if (reach + 1 == count_) continue; // the closing edge of the loop is not a chord
                constexpr double kLengthWeight = 1e-6;
                const Vec3d chord = points_[i + reach] - points_[i];
                const bool is_edge = !uses_of_edge(edge_uses, loop[i], loop[i + reach]).empty();
                best_[at(i, i + reach)] += kLengthWeight * dot(chord, chord) + (is_edge ? last_resort_ : 0);
            }
    }

    std::vector<Triangle> faces() const {
        std::vector<Triangle> result;
        std::vector<std::pair<std::size_t, std::size_t>> chords{{0, count_ - 1}};
        while (!chords.empty()) {
            const auto [i, j] = chords.back();
            chords.pop_back();
            if (j - i < 2) continue;
            const std::size_t k = split_[at(i, j)];
            result.push_back({loop_[i], loop_[k], loop_[j]});
            chords.emplace_back(k, j);
            chords.emplace_back(i, k);
        }
        return result;
    }

  private:
    std::size_t at(std::size_t i, std::size_t j) const { return i * count_ + j; }

    double cost_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
        constexpr double kThin = 1e-6;
        const double area = area_of(a, b, c);
        return area > kThin * dot(c - a, c - a) ? area : area + last_resort_;
    }

    void find_best_split(std::size_t i, std::size_t j) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
            const double cost =
                best_[at(i, k)] + best_[at(k, j)] + cost_of(points_[i], points_[k], points_[j]);
            if (cost < least) {
                least = cost;
                split_[at(i, j)] = static_cast<std::uint16_t>(k);
            }
        }
        best_[at(i, j)] = least;
    }

    const HoleLoop& loop_;
    std::size_t count_;
    double last_resort_ = 0; ///< an additional cost greater than any area
    std::vector<Vec3d> points_;
    std::vector<double> best_;         ///< [count * count] the least cost of filling from i to j > i
    std::vector<std::uint16_t> split_; ///< [count * count] the corner between i and j in that filling
};

static_assert(RepairOptions::kMaxHoleEdges <= std::numeric_limits<std::uint16_t>::max());

/// For each vertex, the area of the component to which it belongs.
std::vector<double> component_areas(const TriangleMesh& mesh) {
    const Components components = find_components(mesh);
    std::vector<double> of_component(components.count), of_vertex(mesh.vertices.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        of_component[components.of_face[face]] += area_of(mesh, mesh.faces[face]);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
        for (const std::uint32_t vertex : mesh.faces[face])
            of_vertex[vertex] = of_component[components.of_face[face]];
    return of_vertex;
}

/// Fills the loops that are wanted, unless they are the rim of a sheet.
/// @param is_wanted    tests a loop before its filling is computed
/// @param is_in_order  tests the faces that would fill the loop
template <typename IsWanted, typename IsInOrder>
ClosedHoles fill_loops(TriangleMesh& mesh, const IsWanted& is_wanted, const IsInOrder& is_in_order) {
    // A filling with a larger share of the area is not a hole in a surface but the other side of a sheet.
    constexpr double kLargestShare = 1.0 / 3;
    const std::vector<HoleLoop> loops = find_hole_loops(mesh);
    if (loops.empty()) return {};
    const std::vector<double> areas = component_areas(mesh);
    const std::vector<EdgeUse> edge_uses = sorted_edge_uses(mesh);
    ClosedHoles result;
    for (const HoleLoop& loop : loops) {
        std::vector<Triangle> filling;
        if (is_wanted(loop)) filling = LeastFilling(mesh, edge_uses, loop).faces();
        double area = 0;
        for (const Triangle& face : filling) area += area_of(mesh, face);
        if (!filling.empty() && area <= kLargestShare * areas[loop[0]] && is_in_order(filling)) {
            mesh.faces.insert(mesh.faces.end(), filling.begin(), filling.end());
            ++result.closed;
        } else {
            ++result.left;
        }
    }
    return result;
}

/// Can faces whose heights are at most `width` fill the loop? If so, their total area is at most the bound
/// below, and so is the area that the loop encloses.
bool may_be_seam(const TriangleMesh& mesh, const HoleLoop& loop, double width) {
    const Vec3d first(mesh.vertices[loop[0]]);
    Vec3d twice_area;
    double perimeter = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3d a(mesh.vertices[loop[i]]), b(mesh.vertices[loop[(i + 1) % loop.size()]]);
        twice_area += cross(a - first, b - first);
        perimeter += length(b - a);
    }
    return length(twice_area) <= static_cast<double>(loop.size() - 2) * width * (perimeter / 2);
}

bool is_no_higher(const TriangleMesh& mesh, const Triangle& face, double height) {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest,
                           length(Vec3d(mesh.vertices[face[(k + 1) % 3]]) - Vec3d(mesh.vertices[face[k]])));
    return 2 * area_of(mesh, face) <= height * longest;
}

} // namespace

ClosedHoles close_small_holes(TriangleMesh& mesh, std::uint32_t max_edges) {
    return fill_loops(
        mesh, [&](const HoleLoop& loop) { return loop.size() <= max_edges; },
        [](const std::vector<Triangle>&) { return true; });
}

std::size_t fill_seams(TriangleMesh& mesh, double width) {
    const auto may_be_filled = [&](const HoleLoop& loop) {
        return loop.size() <= RepairOptions::kMaxHoleEdges && may_be_seam(mesh, loop, width);
    };
    const auto has_no_width = [&](const std::vector<Triangle>& filling) {
        return std::all_of(filling.begin(), filling.end(),
                           [&](const Triangle& face) { return is_no_higher(mesh, face, width); });
    };
    return fill_loops(mesh, may_be_filled, has_no_width).closed;
}

} // namespace echinus
