#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"
#include "exact_map/build/band_builder.hpp"
#include "exact_map/build/cell_intervals.hpp"
#include "geometry/arena.hpp"

#include <echinus/exact_map.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The storage of an IndexArray. Keeps its memory between uses.
class IndexStorage {
  public:
    /// Of numbers that are all below `bound`.
    static constexpr std::size_t bytes_per_number(std::size_t bound) { return bound <= 65536 ? 2 : 4; }

    /// Makes room for so many numbers, all below `bound`; what they are is arbitrary until set.
    void reset(std::size_t size, std::size_t bound) {
        const bool narrow = bytes_per_number(bound) == 2;
        narrow_.reset(narrow ? size : 0);
        wide_.reset(narrow ? 0 : size);
        is_narrow_ = narrow;
    }

    /// Calls visit(pointer to the numbers), of the type that they are stored in.
    template <typename Visit>
    void with_numbers(const Visit& visit) {
        if (is_narrow_)
            visit(narrow_.data());
        else
            visit(wide_.data());
    }

    std::size_t size() const { return narrow_.size() + wide_.size(); }
    IndexArray view() const { return {narrow_, wide_}; }

  private:
    Arena<std::uint16_t> narrow_;
    Arena<std::uint32_t> wide_;
    bool is_narrow_ = true;
};

/// The bands of all cells, as in ExactMapView.
struct Bands {
    Arena<std::uint32_t> offsets; ///< [cell_count + 1]
    Arena<Band> bands;            ///< [band_count + 1]
    IndexStorage references;      ///< faces; edge-on faces have none
    Arena<std::uint16_t> reference_parts;
    Arena<std::int16_t> winding_below; ///< [band_count]
    Arena<CellVolume> volumes;         ///< [cell_count] of an open surface; none of a closed one
};

/// The size of a map's bands, including the outer limits.
std::size_t byte_count(const Bands& bands);

/// Faces of the band that the average reference belongs to: those that a query near the surface meets.
double expected_tests(const Bands& bands);

/// How finely bands tell directions and gaps apart.
struct BandDetail {
    OctahedralCells cells;
    int gap_halvings = GapStates::kMostHalvings; ///< that an open surface's gaps may take
};

/// Finds the bands of every cell; keeps its memory for the next time.
class BandFinder {
  public:
    /// Faces pass through no more cells, counted together, whatever the limit.
    static constexpr std::size_t kMostIntervals = std::size_t{1} << 28;

    /// Finds the bands of every cell and the winding numbers between them; reuses the memory of `result`.
    /// Does not depend on the number of threads.
    /// @param surface     the map but for its bands; only of an open surface it has to be there
    /// @param byte_limit  on byte_count(). It holds for edge-on faces too, as if they had references. What
    ///                    exceeds it is given up as soon as that shows, so that time and memory are bounded
    ///                    by the limit, the faces and the cells
    /// @returns  false when the limit was exceeded; `result` is as it was then
    /// @throws Error InvalidMesh when a winding number is too large to be stored
    bool find(const LatticeMesh& lattice, const ExactMapView& surface, const BandDetail& detail,
              unsigned thread_count, std::size_t byte_limit, Bands& result);

  private:
    /// Bands of consecutive cells in a worker's list, and where they go.
    struct Block {
        std::size_t worker;
        std::size_t first_cell, cell_count;
        std::size_t first_count; ///< of BandList::band_counts; further numbers of the list's arrays:
        std::size_t first_band, band_count, first_reference, reference_count, first_volume;
        std::size_t to_band, to_reference;
    };

    void find_blocks(const GapStates* gap_states, const OctahedralCells& cells, unsigned thread_count,
                     std::size_t bytes_per_reference, LimitedCount& byte_count);
    void make_room(std::size_t cell_count, std::size_t face_count, Bands& result);
    void copy(const Block& block, Bands& result) const;

    CellIntervals intervals_;
    std::vector<BandList> lists_; ///< by worker
    std::vector<Block> blocks_;   ///< ascending
};

} // namespace echinus
