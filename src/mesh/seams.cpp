#include "mesh/seams.hpp"

#include "geometry/arena.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/faces.hpp"
#include "mesh/require_valid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

namespace echinus {

namespace {

/// An edge of a face seen from its lower vertex: twice the other vertex, plus 1 if the face runs towards it.
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

/// Compares all pairs without a branch, which is fastest for the few edges of an ordinary vertex.
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
    std::vector<std::uint32_t> ends(vertex_count + 1); // 32 bits suffice for three half edges of each face
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

namespace {

constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

/// The cells of a grid of points. A double represents the number of a cell exactly, or the number is so large
/// that float does not resolve cells, and each cell contains at most one point.
class Grid {
  public:
    using Cell = std::array<double, 3>;

    explicit Grid(double width)
        : cell_size_(width > 0 ? kWidths * width : std::numeric_limits<double>::min()) {}

    /// Calls visit(cell) for each cell, at most eight, that contains points within the given width of a
    /// place.
    template <typename Visit>
    void for_each_near(const Vec3d& place, double width, const Visit& visit) const {
        const Cell low = cell_at(place - Vec3d{width, width, width});
        const Cell high = cell_at(place + Vec3d{width, width, width});
        for (int corner = 0; corner < 8; ++corner) {
            Cell cell = low;
            bool again = false;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if ((corner >> axis & 1) == 0) continue;
                again = again || high[axis] == low[axis];
                cell[axis] = high[axis];
            }
            if (!again) visit(cell);
        }
    }

    Cell cell_at(const Vec3d& place) const {
        return {std::floor(place.x / cell_size_), std::floor(place.y / cell_size_),
                std::floor(place.z / cell_size_)};
    }

  private:
    /// Large enough for few points to be near more than one cell, and small enough for a cell to contain few
    /// points that are not near each other.
    static constexpr double kWidths = 8;

    double cell_size_;
};

struct HashOfCell {
    std::size_t operator()(const Grid::Cell& cell) const {
        std::size_t hash = 0;
        for (const double number : cell)
            hash = (hash ^ std::hash<double>()(number)) * 0x9e3779b97f4a7c15U + (hash >> 29U);
        return hash;
    }
};

} // namespace

std::vector<std::uint32_t> find_open_vertices(std::span<const Triangle> faces, std::size_t vertex_count) {
    if (is_closed(faces, vertex_count)) return {};
    std::vector<std::uint32_t> vertices;
    for_each_edge(sorted_edge_uses(faces), [&](std::span<const EdgeUse> uses) {
        if (!is_balanced(uses)) vertices.insert(vertices.end(), {uses[0].low, uses[0].high});
    });
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

std::vector<std::uint32_t> join_near_vertices(std::span<const Vec3f> vertices,
                                              std::span<const std::uint32_t> open, double width) {
    const Grid grid(width);
    // The last vertex in each cell that represents itself.
    std::unordered_map<Grid::Cell, std::uint32_t, HashOfCell> last_in_cell;
    std::vector<std::uint32_t> next(open.size(), kNoEdge), result(open.begin(), open.end());
    for (std::uint32_t i = 0; i < open.size(); ++i) {
        const Vec3d place(vertices[open[i]]);
        std::uint32_t first = i;
        grid.for_each_near(place, width, [&](const Grid::Cell& cell) {
            const auto found = last_in_cell.find(cell);
            if (found == last_in_cell.end()) return;
            for (std::uint32_t k = found->second; k != kNoEdge; k = next[k])
                if (length(Vec3d(vertices[open[k]]) - place) <= width) first = std::min(first, k);
        });
        result[i] = open[first];
        if (first != i) continue;
        const auto [cell, is_new] = last_in_cell.try_emplace(grid.cell_at(place), i);
        if (!is_new) next[i] = std::exchange(cell->second, i);
    }
    return result;
}

TriangleMesh with_common_corners(const TriangleMesh& mesh, double width) {
    const std::vector<std::uint32_t> open = find_open_vertices(mesh.faces, mesh.vertices.size());
    const std::vector<std::uint32_t> joined = join_near_vertices(mesh.vertices, open, width);
    TriangleMesh result = mesh;
    if (open == joined) return result;
    std::unordered_map<std::uint32_t, std::uint32_t> first_of;
    for (std::size_t i = 0; i < open.size(); ++i) first_of.emplace(open[i], joined[i]);
    for (Triangle& face : result.faces)
        for (std::uint32_t& vertex : face)
            if (const auto found = first_of.find(vertex); found != first_of.end()) vertex = found->second;
    return result;
}

namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// The bits of a position, with -0 as 0, so that equal positions have equal bits, and the order is total even
/// with NaN.
std::array<std::uint32_t, 3> position_key(const Vec3f& p) {
    // x + 0 is x, except that -0 + 0 is 0.
    return {bit_cast<std::uint32_t>(p.x + 0.0F), bit_cast<std::uint32_t>(p.y + 0.0F),
            bit_cast<std::uint32_t>(p.z + 0.0F)};
}

/// For each vertex, the first vertex at the same position.
std::vector<std::uint32_t> first_at_same_position(const std::vector<Vec3f>& vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto key_a = position_key(vertices[a]);
        const auto key_b = position_key(vertices[b]);
        return key_a != key_b ? key_a < key_b : a < b;
    });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && position_key(vertices[order[i]]) == position_key(vertices[order[i - 1]]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

} // namespace

WeldedMesh weld_with_sources(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = first_at_same_position(mesh.vertices);
    std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
        require_vertices_exist(mesh, face);
        for (std::uint32_t vertex : mesh.faces[face]) new_index[first[vertex]] = 0;
    }

    WeldedMesh welded;
    welded.mesh.origin = mesh.origin;
    for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex)
        if (new_index[vertex] != kUnused) {
            new_index[vertex] = kept_as<std::uint32_t>(welded.sources.size());
            welded.sources.push_back(kept_as<std::uint32_t>(vertex));
            welded.mesh.vertices.push_back(mesh.vertices[vertex]);
        }
    welded.mesh.faces.reserve(mesh.faces.size());
    for (const Triangle& face : mesh.faces)
        welded.mesh.faces.push_back(
            {new_index[first[face[0]]], new_index[first[face[1]]], new_index[first[face[2]]]});
    return welded;
}

TriangleMesh weld(const TriangleMesh& mesh) {
    return weld_with_sources(mesh).mesh;
}

} // namespace echinus
