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

/// The storage of an IndexArray. It keeps its memory between uses.
class IndexStorage {
  public:
    /// The bytes of one number, if all numbers are below `bound`.
    static constexpr std::size_t bytes_per_number(std::size_t bound) { return bound <= 65536 ? 2 : 4; }

    /// Makes room for this many numbers, all below `bound`; their values are arbitrary until set.
    void reset(std::size_t size, std::size_t bound) {
        const bool narrow = bytes_per_number(bound) == 2;
        narrow_.reset(narrow ? size : 0);
        wide_.reset(narrow ? 0 : size);
        is_narrow_ = narrow;
    }

    /// Calls visit(pointer to the numbers) with a pointer to the type that they are stored in.
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
    IndexStorage references;      ///< faces; those seen edge-on have no references
    Arena<std::uint16_t> reference_parts;
    Arena<std::int16_t> winding_below; ///< [band_count]
    Arena<CellVolume> volumes;         ///< [cell_count] for an open surface, otherwise empty
};

/// The size of a map's bands, including the outer limits.
std::size_t byte_count(const Bands& bands);

/// The number of faces in the band of an average reference: those that a query near the surface tests.
double expected_tests(const Bands& bands);

/// How finely bands distinguish directions and gaps.
struct BandDetail {
    OctahedralCells cells;
    int gap_halvings = GapStates::kMostHalvings; ///< the most halvings of a gap of an open surface
};

/// Finds the bands of every cell. It keeps its memory for the next call.
class BandFinder {
  public:
    /// The most cells that all faces together may pass through, whatever the limit of bytes.
    static constexpr std::size_t kMostIntervals = std::size_t{1} << 28;

    /// Finds the bands of every cell and the winding numbers between them; reuses the memory of `result`. The
    /// result does not depend on the number of threads.
    /// @param surface     the map without its bands; needed only for an open surface
    /// @param byte_limit  the limit of byte_count(). Faces seen edge-on count as if they had references. The
    ///                    search stops as soon as the limit is known to be exceeded, so that time and memory
    ///                    are bounded by the limit, the faces and the cells
    /// @returns  false if the limit was exceeded; `result` is then unchanged
    /// @throws Error InvalidMesh if a winding number is too large to be stored
    bool find(const LatticeMesh& lattice, const ExactMapView& surface, const BandDetail& detail,
              unsigned thread_count, std::size_t byte_limit, Bands& result);

  private:
    /// Bands of consecutive cells in a worker's list, and their destination.
    struct Block {
        std::size_t worker;
        std::size_t first_cell, cell_count;
        std::size_t first_count; ///< index into BandList::band_counts; more indices into the list's arrays:
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
