#include "mesh/seams.hpp"

#include "mesh/edges.hpp"
#include "mesh/is_closed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

namespace echinus {

namespace {

constexpr std::uint32_t kNoEdge = std::numeric_limits<std::uint32_t>::max();

/// The cells of a grid in which places lie. A double holds the number of a cell exactly, or where it is too
/// large for that, float does not resolve cells, and a cell holds one place.
class Grid {
  public:
    using Cell = std::array<double, 3>;

    explicit Grid(double width)
        : cell_size_(width > 0 ? kWidths * width : std::numeric_limits<double>::min()) {}

    /// Calls visit(cell) for each cell, at most eight, that holds places within the width of a place.
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
    /// So large that few places are near two cells, so small that a cell holds few places that are not near.
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
    std::unordered_map<Grid::Cell, std::uint32_t, HashOfCell> last_in_cell; // which stands for itself
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

} // namespace echinus
