#include "exact_map/centre_search.hpp"

#include "exact_map/border.hpp"

#include <utility>

namespace echinus {

namespace {

/// Faces on the list of the average reference, which is what a particle near the surface meets.
double cost_of(const LatticeMesh& lattice, unsigned thread_count, BandFinder& finder) {
    constexpr std::uint32_t kDivisions = 12; // cells much smaller would cost much and rank centres alike
    Bands bands;
    // The border does not matter to the length of lists.
    finder.find(lattice, {}, OctahedralCells(kDivisions), thread_count, bands);
    return expected_tests(bands);
}

} // namespace

void snap_around_best_centre(LatticeSnapper& snapper, std::span<const Vec3f> vertices, unsigned thread_count,
                             BandFinder& finder, LatticeMesh& best) {
    snapper.snap(vertices, best);
    double best_cost = cost_of(best, thread_count, finder);
    const double radius = best.radius;
    LatticeMesh other;
    for (double step : {0.25, 0.125, 0.0625}) {
        const Vec3d start(best.centre);
        for (const Vec3d& side : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0},
                                  Vec3d{0, 0, 1}, Vec3d{0, 0, -1}}) {
            snapper.snap(vertices, Vec3f(start + side * (step * radius)), other);
            const double cost = cost_of(other, thread_count, finder);
            if (!(cost < best_cost)) continue;
            best_cost = cost;
            std::swap(best, other);
        }
    }
}

} // namespace echinus
