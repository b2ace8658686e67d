#include "exact_map/build/centre_search.hpp"

#include "directions/centre_search.hpp"
#include "exact_map/build/border.hpp"

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
    snap_at_lowest_cost(
        snapper, vertices, [&](const LatticeMesh& lattice) { return cost_of(lattice, thread_count, finder); },
        best);
}

} // namespace echinus
