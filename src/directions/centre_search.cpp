#include "directions/centre_search.hpp"

#include <utility>

namespace echinus {

void snap_at_lowest_cost(LatticeSnapper& snapper, std::span<const Vec3f> vertices,
                         const std::function<double(const LatticeMesh&)>& cost_of, LatticeMesh& best) {
    snapper.snap(vertices, best);
    double best_cost = cost_of(best);
    const double radius = best.radius;
    LatticeMesh other;
    for (double step : {0.25, 0.125, 0.0625}) {
        const Vec3d start(best.centre);
        for (const Vec3d& side : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0},
                                  Vec3d{0, 0, 1}, Vec3d{0, 0, -1}}) {
            snapper.snap(vertices, Vec3f(start + side * (step * radius)), other);
            const double cost = cost_of(other);
            if (!(cost < best_cost)) continue;
            best_cost = cost;
            std::swap(best, other);
        }
    }
}

} // namespace echinus
