#include "exact_map/bands.hpp"

#include "directions/crossing.hpp"
#include "exact_map/cell_cover.hpp"
#include "exact_map/layout.hpp"
#include "geometry/parallel.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <limits>
#include <mutex>
#include <tuple>

namespace echinus {

namespace {

/// A face's range in a cell, in band units, rounded outwards.
struct Interval {
    std::uint16_t lower, upper;
    std::uint32_t face;
    std::uint16_t parts;

    bool operator<(const Interval& other) const {
        return std::tie(lower, upper, face) < std::tie(other.lower, other.upper, other.face);
    }
};

struct CellInterval {
    std::uint32_t cell;
    Interval interval;
};

struct CellIntervals {
    std::vector<std::uint32_t> offsets; ///< [cell_count + 1]
    std::vector<Interval> intervals;    ///< by cell, ascending
};

std::array<LatticePoint, 3> corners_of(const LatticeMesh& lattice, std::uint32_t face) {
    const Triangle& t = lattice.faces[face];
    return {lattice.vertices[t[0]], lattice.vertices[t[1]], lattice.vertices[t[2]]};
}

Interval interval_of(const CellCover& cover, std::uint32_t face) {
    constexpr double kRounding = 0.01; // lattice steps, far above what clipping loses
    const auto lower = static_cast<std::int64_t>(std::max(0.0, cover.nearest - kRounding));
    const auto upper = static_cast<std::int64_t>(cover.farthest + kRounding) + 1;
    return {static_cast<std::uint16_t>(band_unit_of(lower)),
            static_cast<std::uint16_t>(band_unit_of(upper) + 1), face, cover.parts};
}

CellIntervals find_intervals(const LatticeMesh& lattice, const OctahedralCells& cells,
                             unsigned thread_count) {
    std::vector<std::vector<CellInterval>> batches;
    std::mutex mutex;
    parallel_for(lattice.faces.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        std::vector<CellInterval> batch;
        std::vector<CellCover> covers;
        for (std::size_t face = begin; face < end; ++face) {
            covers.clear();
            cover_cells(cells, corners_of(lattice, static_cast<std::uint32_t>(face)), covers);
            for (const CellCover& cover : covers)
                batch.push_back({cover.cell, interval_of(cover, static_cast<std::uint32_t>(face))});
        }
        const std::lock_guard lock(mutex);
        batches.push_back(std::move(batch));
    });

    CellIntervals result;
    result.offsets.resize(cells.count() + 1);
    for (const auto& batch : batches)
        for (const CellInterval& item : batch) ++result.offsets[item.cell + 1];
    for (std::size_t cell = 0; cell < cells.count(); ++cell) result.offsets[cell + 1] += result.offsets[cell];
    result.intervals.resize(result.offsets.back());
    std::vector<std::uint32_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (const auto& batch : batches)
        for (const CellInterval& item : batch) result.intervals[next[item.cell]++] = item.interval;
    parallel_for(cells.count(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            std::sort(result.intervals.begin() + result.offsets[cell],
                      result.intervals.begin() + result.offsets[cell + 1]);
    });
    return result;
}

/// A ray strictly inside a cell.
LatticePoint middle_of(const OctahedralCells& cells, std::uint32_t octant, std::int32_t i, std::int32_t j,
                       bool down) {
    const std::int64_t k = cells.divisions() - (down ? 2 : 1) - i - j;
    const std::int64_t third = down ? 2 : 1;
    const std::int64_t scale = kLatticeExtent / (3 * cells.divisions());
    return {(octant & 1U ? -1 : 1) * scale * (3 * i + third),
            (octant & 2U ? -1 : 1) * scale * (3 * j + third),
            (octant & 4U ? -1 : 1) * scale * (3 * k + third)};
}

class BandBuilder {
  public:
    BandBuilder(const LatticeMesh& lattice, const CellIntervals& intervals)
        : lattice_(lattice), intervals_(intervals) {
        result_.offsets.reserve(intervals.offsets.size());
        result_.offsets.push_back(0);
    }

    void add_cell(std::uint32_t cell, const LatticePoint& middle) {
        const std::uint32_t first = intervals_.offsets[cell];
        const std::uint32_t last = intervals_.offsets[cell + 1];
        const std::size_t first_band = result_.bands.size();
        for (std::uint32_t i = first; i < last;) i = add_band(i, last, middle);
        // Beyond the outermost band the winding number is 0; from there inwards each band adds what it holds.
        int winding = 0;
        for (std::size_t band = result_.bands.size(); band-- > first_band;) {
            winding += changes_[band - first_band];
            if (winding > std::numeric_limits<std::int16_t>::max() ||
                winding < std::numeric_limits<std::int16_t>::min())
                throw Error(ErrorCode::InvalidMesh, "the surface winds around a place more than 32767 times");
            result_.winding_below[band] = static_cast<std::int16_t>(winding);
        }
        changes_.clear();
        result_.offsets.push_back(static_cast<std::uint32_t>(result_.bands.size()));
    }

    Bands finish() {
        result_.bands.push_back({0, 0, static_cast<std::uint32_t>(result_.references.size())});
        return std::move(result_);
    }

  private:
    /// Merges intervals that overlap or touch, from number i on. Returns the first that is left.
    std::uint32_t add_band(std::uint32_t i, std::uint32_t last, const LatticePoint& middle) {
        Band band{intervals_.intervals[i].lower, intervals_.intervals[i].upper,
                  static_cast<std::uint32_t>(result_.references.size())};
        int change = 0;
        for (; i < last && intervals_.intervals[i].lower <= band.upper; ++i) {
            const Interval& interval = intervals_.intervals[i];
            band.upper = std::max(band.upper, interval.upper);
            const auto corners = corners_of(lattice_, interval.face);
            const FaceCone cone(corners[0], corners[1], corners[2]);
            if (cone.edge_on()) continue; // no ray meets it, but it does part the inside from the outside
            result_.references.push_back(interval.face);
            result_.reference_parts.push_back(interval.parts);
            if (cone.meets(middle)) change += cone.outward() ? 1 : -1;
        }
        result_.bands.push_back(band);
        result_.winding_below.push_back(0);
        changes_.push_back(change);
        return i;
    }

    const LatticeMesh& lattice_;
    const CellIntervals& intervals_;
    std::vector<int> changes_; // of the winding number across each band of the cell at hand, inwards
    Bands result_;
};

} // namespace

Bands find_bands(const LatticeMesh& lattice, const OctahedralCells& cells, unsigned thread_count) {
    const CellIntervals intervals = find_intervals(lattice, cells, thread_count);
    BandBuilder builder(lattice, intervals);
    for (std::uint32_t octant = 0; octant < 8; ++octant)
        for (std::int32_t i = 0; i < cells.divisions(); ++i)
            for (std::int32_t j = 0; j < cells.divisions() - i; ++j)
                for (bool down : {false, true}) {
                    if (down && i + j == cells.divisions() - 1) continue;
                    builder.add_cell(cells.index(octant, i, j, down), middle_of(cells, octant, i, j, down));
                }
    return builder.finish();
}

} // namespace echinus
