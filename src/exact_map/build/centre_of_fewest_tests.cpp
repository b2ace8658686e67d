#include "exact_map/build/centre_of_fewest_tests.hpp"

#include "directions/lattice.hpp"
#include "exact_map/build/resolution.hpp"

#include <limits>

namespace echinus {

namespace {

/// Faces on the list of the average reference, which is what a particle near the surface meets, in maps of
/// few cells.
class ListLengths {
  public:
    ListLengths(unsigned thread_count, BandFinder& finder) : thread_count_(thread_count), finder_(finder) {}

    /// The first centre decides on the cells; another for which they take too many bytes is none.
    double of(const LatticeMesh& lattice) {
        bool found = find(lattice);
        for (; !found && is_first_; found = find(lattice)) divisions_ /= 2;
        is_first_ = false;
        return found ? expected_tests(bands_) : std::numeric_limits<double>::infinity();
    }

  private:
    bool find(const LatticeMesh& lattice) {
        const std::size_t limit = default_byte_limit(lattice.faces.size(), lattice.vertices.size());
        // The border does not matter to the length of lists.
        return finder_.find(lattice, {}, {OctahedralCells(divisions_)}, thread_count_, limit, bands_);
    }

    unsigned thread_count_;
    BandFinder& finder_;
    Bands bands_;
    std::uint32_t divisions_ = 12; ///< more would take much time and rank centres alike
    bool is_first_ = true;
};

} // namespace

void snap_around_best_centre(LatticeSnapper& snapper, std::span<const Vec3f> vertices, unsigned thread_count,
                             BandFinder& finder, LatticeMesh& best) {
    ListLengths lengths(thread_count, finder);
    snap_at_lowest_cost(
        snapper, vertices, [&](const LatticeMesh& lattice) { return lengths.of(lattice); }, best);
}

} // namespace echinus
