#pragma once

#include "directions/octahedral_cells.hpp"
#include "exact_map/build/cell_intervals.hpp"
#include "exact_map/build/gap_states.hpp"
#include "geometry/arena.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// The volume of a cell within the bounding sphere and the uncertain part of it, up to a common factor.
struct CellVolume {
    double uncertain, whole;
};

/// Bands of some cells, one after the other; the contents are as in ExactMapView.
struct BandList {
    Arena<std::uint32_t> band_counts; ///< [cell_count]
    Arena<Band> bands;
    Arena<std::int16_t> winding_below;
    Arena<std::uint32_t> references;
    Arena<std::uint16_t> reference_parts;
    Arena<CellVolume> volumes; ///< [cell_count] for an open surface, otherwise empty

    void clear();
    /// Reserves the memory that this many more intervals and cells usually need.
    void make_room(std::size_t interval_count, std::size_t cell_count);
};

/// Sorts the intervals of a cell.
class IntervalSorter {
  public:
    /// @returns  the same intervals, ascending; valid until the next call
    std::span<const Interval> sorted(std::span<Interval> intervals);

  private:
    static constexpr std::size_t kFew = 40;

    std::span<const Interval> ranked(std::span<const Interval> intervals);

    std::array<Interval, kFew> sorted_;
};

/// Turns the intervals of cells into bands, cell by cell.
class BandBuilder {
  public:
    /// @param gap_states  for an open surface; null for a closed one
    /// @param result      the bands are appended to it
    BandBuilder(const OctahedralCells& cells, const GapStates* gap_states, BandList& result)
        : cells_(cells), gap_states_(gap_states), result_(result) {}

    /// @param intervals  the intervals of the cell; they are sorted
    /// @throws Error InvalidMesh if a winding number is too large to be stored
    void add_cell(std::uint32_t cell, std::span<Interval> intervals);

  private:
    struct MergedBand {
        std::uint16_t lower, upper;
        std::span<const Interval> intervals;
        int winding_below; ///< winding number below the band, on the ray through the cell's middle
    };

    void merge(std::span<const Interval> intervals);
    void append(const MergedBand& band, std::int16_t winding_below);
    template <typename Belongs>
    void append_references(std::span<const Interval> intervals, const Belongs& belongs);
    void append_limit(std::uint16_t lower, std::uint16_t upper, std::int16_t winding_below);
    void append_closed();
    std::optional<std::uint16_t> split_of(std::span<const Interval> intervals);
    void append_split(const MergedBand& band, std::uint16_t limit, std::int16_t winding_below);
    void append_open(std::uint32_t cell);
    std::int16_t append_gap(std::uint32_t cell, std::uint16_t lower, std::uint16_t upper, int crossings);
    double l1_at_sphere(std::uint32_t cell) const;

    OctahedralCells cells_;
    const GapStates* gap_states_;
    BandList& result_;
    IntervalSorter sorter_;
    std::vector<MergedBand> merged_;
    std::vector<GapPiece> pieces_;
    std::vector<std::uint16_t> uppers_;
    double uncertain_ = 0; ///< the uncertain volume of the current cell
};

} // namespace echinus
