#pragma once

#include "rivals/classified_grid/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

/// Which cells of a grid a face meets: separating axes, with cells wider by GridFrame::kSlack. May name a
/// cell too many, never one too few.
namespace echinus::rivals {

/// A face seen along one axis, as three half-planes that a square must reach to meet it (Schwarz and Seidel,
/// "Fast parallel surface and solid voxelization on GPUs", 2010, section 4). All numbers are whole and below
/// 2^53.
class ProjectedFace {
  public:
    /// @param u, v  the axes that are left
    ProjectedFace(const std::array<std::array<double, 3>, 3>& corners, int u, int v, double half) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto &a = corners[k], &b = corners[(k + 1) % 3], &c = corners[(k + 2) % 3];
            double mu = a[v] - b[v], mv = b[u] - a[u];
            const double third = mu * (c[u] - a[u]) + mv * (c[v] - a[v]);
            if (third < 0) mu = -mu, mv = -mv;
            // Seen edge-on: the plane and the other views tell.
            if (third == 0) mu = mv = 0;
            edges_[k] = {mu, mv, half * (std::fabs(mu) + std::fabs(mv)) - mu * a[u] - mv * a[v]};
        }
    }

    bool reached(double u, double v) const {
        for (const Edge& edge : edges_)
            if (edge.mu * u + edge.mv * v + edge.reach < 0) return false;
        return true;
    }

  private:
    struct Edge {
        double mu, mv, reach;
    };
    std::array<Edge, 3> edges_;
};

/// Calls visit(cell) for each cell that a face meets.
template <typename Visit>
void for_each_cell(const GridFrame& frame, const std::array<LatticePoint, 3>& face, const Visit& visit) {
    const std::array<std::int32_t, 3> origin{frame.origin.x, frame.origin.y, frame.origin.z};
    const std::int32_t size = frame.cell_steps;
    std::array<std::array<double, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
        corners[k] = {double(face[k].x), double(face[k].y), double(face[k].z)};
    std::array<std::int32_t, 3> first{}, last{};
    for (std::size_t d = 0; d < 3; ++d) {
        const auto [low, high] = std::minmax({corners[0][d], corners[1][d], corners[2][d]});
        const double slack = GridFrame::kSlack;
        first[d] = std::clamp(static_cast<std::int32_t>(std::floor((low - slack - origin[d]) / size)), 0,
                              frame.cell_counts[d] - 1);
        last[d] = std::clamp(static_cast<std::int32_t>(std::floor((high + slack - origin[d]) / size)), 0,
                             frame.cell_counts[d] - 1);
    }
    const LatticePoint n = cross(face[1] - face[0], face[2] - face[0]);
    const std::array<double, 3> normal{double(n.x), double(n.y), double(n.z)};
    // Columns of cells run along the normal's longest axis, so that few cells of each meet the plane.
    int d = std::fabs(normal[1]) > std::fabs(normal[0]) ? 1 : 0;
    if (std::fabs(normal[2]) > std::fabs(normal[d])) d = 2;
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    const double half = size * 0.5 + GridFrame::kSlack;
    const ProjectedFace along(corners, u, v, half), across_u(corners, v, d, half),
        across_v(corners, d, u, half);
    const auto middle = [&](int axis, std::int32_t i) {
        return origin[axis] + (static_cast<double>(i) + 0.5) * size;
    };
    const double reach =
        half * (std::fabs(normal[0]) + std::fabs(normal[1]) + std::fabs(normal[2])) / std::fabs(normal[d]) +
        1;
    for (std::int32_t j = first[v]; j <= last[v]; ++j)
        for (std::int32_t i = first[u]; i <= last[u]; ++i) {
            const double at_u = middle(u, i), at_v = middle(v, j);
            if (!along.reached(at_u, at_v)) continue;
            std::int32_t from = first[d], to = last[d];
            if (normal[d] != 0) {
                const double plane =
                    corners[0][d] -
                    (normal[u] * (at_u - corners[0][u]) + normal[v] * (at_v - corners[0][v])) / normal[d];
                const double low = std::ceil((plane - reach - origin[d]) / size - 0.5);
                const double high = std::floor((plane + reach - origin[d]) / size - 0.5);
                from = static_cast<std::int32_t>(std::max(low, double(from)));
                to = static_cast<std::int32_t>(std::min(high, double(to)));
            }
            for (std::int32_t k = from; k <= to; ++k) {
                const double at_d = middle(d, k);
                if (!across_u.reached(at_v, at_d) || !across_v.reached(at_d, at_u)) continue;
                std::array<std::int32_t, 3> cell{};
                cell[d] = k;
                cell[u] = i;
                cell[v] = j;
                visit(CellPlace{cell[0], cell[1], cell[2]});
            }
        }
}

} // namespace echinus::rivals
