#include "exact_map/bands.hpp"

#include "directions/crossing.hpp"
#include "exact_map/cell_cover.hpp"
#include "exact_map/gap_states.hpp"
#include "exact_map/layout.hpp"
#include "geometry/parallel.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
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

struct CellIntervals {
    std::vector<std::uint32_t> offsets; ///< [cell_count + 1]
    std::vector<Interval> intervals;    ///< by cell, ascending

    std::span<const Interval> of(std::uint32_t cell) const {
        return std::span(intervals).subspan(offsets[cell], offsets[cell + 1] - offsets[cell]);
    }
};

Interval interval_of(const CellCover& cover, std::uint32_t face) {
    constexpr double kRounding = 0.01; // lattice steps, far above what the cover rounds
    const auto lower = static_cast<std::int64_t>(std::max(0.0, cover.nearest - kRounding));
    const auto upper = static_cast<std::int64_t>(cover.farthest + kRounding) + 1;
    return {static_cast<std::uint16_t>(band_unit_of(lower)),
            static_cast<std::uint16_t>(band_unit_of(upper) + 1), face, cover.parts};
}

/// Asked while faces are covered, before their number fills the memory.
void require_manageable(std::size_t total) {
    constexpr std::size_t kMost = std::size_t{1} << 28; // 16 bytes each, for the moment
    if (total <= kMost) return;
    throw Error(ErrorCode::InvalidMesh, "the faces pass through cells more than " + std::to_string(kMost) +
                                            " times, which is more than a map can hold; take fewer cells, or "
                                            "drop faces that lie on each other");
}

/// What one thread found, in the order of its faces.
struct FoundCovers {
    std::size_t first_face;
    std::vector<std::uint32_t> cells;
    std::vector<Interval> intervals;
};

std::vector<FoundCovers> cover_all_faces(const LatticeMesh& lattice, const OctahedralCells& cells,
                                         unsigned thread_count) {
    std::vector<FoundCovers> found;
    std::mutex mutex;
    std::atomic<std::size_t> total = 0;
    parallel_for(lattice.faces.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        FoundCovers mine{begin, {}, {}};
        mine.cells.reserve(6 * (end - begin));
        mine.intervals.reserve(6 * (end - begin));
        std::vector<CellCover> covers;
        for (std::size_t i = begin; i < end; ++i) {
            const auto face = static_cast<std::uint32_t>(i);
            const auto corners = lattice.corners(face);
            if (is_collapsed(corners)) continue;
            covers.clear();
            cover_cells(cells, corners, covers);
            require_manageable(total += covers.size());
            for (const CellCover& cover : covers) {
                mine.cells.push_back(cover.cell);
                mine.intervals.push_back(interval_of(cover, face));
            }
        }
        const std::lock_guard lock(mutex);
        found.push_back(std::move(mine));
    });
    return found;
}

CellIntervals find_intervals(const LatticeMesh& lattice, const OctahedralCells& cells,
                             unsigned thread_count) {
    const std::vector<FoundCovers> found = cover_all_faces(lattice, cells, thread_count);
    std::size_t total = 0;
    for (const FoundCovers& part : found) total += part.cells.size();
    CellIntervals result;
    result.offsets.resize(cells.count() + 1);
    for (const FoundCovers& part : found)
        for (std::uint32_t cell : part.cells) ++result.offsets[cell + 1];
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.intervals.resize(total);
    std::vector<std::uint32_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (const FoundCovers& part : found)
        for (std::size_t i = 0; i < part.cells.size(); ++i)
            result.intervals[next[part.cells[i]]++] = part.intervals[i];
    // Sorting also removes the order in which threads delivered.
    parallel_for(cells.count(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            std::sort(result.intervals.begin() + result.offsets[cell],
                      result.intervals.begin() + result.offsets[cell + 1]);
    });
    return result;
}

std::int16_t stored_winding(int winding) {
    if (winding > std::numeric_limits<std::int16_t>::max() ||
        winding < -std::numeric_limits<std::int16_t>::max() + 1)
        throw Error(ErrorCode::InvalidMesh, "the surface winds around a place more than 32766 times");
    return static_cast<std::int16_t>(winding);
}

/// Appends the bands of consecutive cells.
class BandBuilder {
  public:
    /// @param gap_states  of an open surface; none when it is closed
    BandBuilder(const LatticeMesh& lattice, const OctahedralCells& cells, const CellIntervals& intervals,
                const GapStates* gap_states)
        : lattice_(lattice), cells_(cells), intervals_(intervals), gap_states_(gap_states) {}

    void add_cell(std::uint32_t cell) {
        merge_intervals(cell);
        if (gap_states_ == nullptr)
            append_closed();
        else
            append_open(cell);
        result_.offsets.push_back(static_cast<std::uint32_t>(result_.bands.size()));
    }

    Bands take() { return std::move(result_); }

  private:
    struct MergedBand {
        std::uint16_t lower, upper;
        std::span<const Interval> intervals;
        int winding_below; ///< on the ray through the cell's middle
    };

    /// Merges intervals that overlap or touch, and counts what the middle ray crosses.
    void merge_intervals(std::uint32_t cell) {
        merged_.clear();
        std::span<const Interval> rest = intervals_.of(cell);
        while (!rest.empty()) {
            std::uint16_t upper = rest.front().upper;
            std::size_t count = 1;
            for (; count < rest.size() && rest[count].lower <= upper; ++count)
                upper = std::max(upper, rest[count].upper);
            merged_.push_back({rest.front().lower, upper, rest.first(count), 0});
            rest = rest.subspan(count);
        }
        const LatticePoint middle = cells_.middle(cell);
        int winding = 0;
        for (std::size_t band = merged_.size(); band-- > 0;) {
            winding += crossings(merged_[band].intervals, middle);
            merged_[band].winding_below = winding;
        }
    }

    int crossings(std::span<const Interval> intervals, const LatticePoint& middle) const {
        int sum = 0;
        for (const Interval& interval : intervals) {
            if ((interval.parts >> OctahedralCells::middle_part() & 1) == 0) continue;
            const auto corners = lattice_.corners(interval.face);
            const FaceCone cone(corners[0], corners[1], corners[2]);
            if (!cone.edge_on() && cone.meets(middle)) sum += cone.outward() ? 1 : -1;
        }
        return sum;
    }

    void append(const MergedBand& band, std::int16_t winding_below) {
        append_limit(band.lower, band.upper, winding_below);
        for (const Interval& interval : band.intervals) append_reference(interval);
    }

    void append_reference(const Interval& interval) {
        const auto corners = lattice_.corners(interval.face);
        if (dot(corners[0], cross(corners[1], corners[2])) == 0)
            return; // edge-on: no ray meets it, but it does part the inside from the outside
        result_.references.push_back(interval.face);
        result_.reference_parts.push_back(interval.parts);
    }

    void append_limit(std::uint16_t lower, std::uint16_t upper, std::int16_t winding_below) {
        result_.bands.push_back({lower, upper, static_cast<std::uint32_t>(result_.references.size())});
        result_.winding_below.push_back(winding_below);
    }

    void append_closed() {
        for (const MergedBand& band : merged_) {
            const std::int16_t winding_below = stored_winding(band.winding_below);
            if (const std::optional<std::uint16_t> limit = split_of(band.intervals))
                append_split(band, *limit, winding_below);
            else
                append(band, winding_below);
        }
    }

    /// Where to cut a band in two, so that a query need look only at the faces of its side: those of the
    /// lower half tell how often the ray crosses the surface before the particle, those of the upper how
    /// often beyond. Faces on both sides are listed twice.
    std::optional<std::uint16_t> split_of(std::span<const Interval> intervals) {
        constexpr std::size_t kLeastFaces = 6;
        constexpr double kLeastGain = 0.3; // of the cost; for less, memory is better spent on more cells
        const std::size_t count = intervals.size();
        if (count < kLeastFaces) return std::nullopt;
        uppers_.clear();
        for (const Interval& interval : intervals) uppers_.push_back(interval.upper);
        std::sort(uppers_.begin(), uppers_.end());
        std::optional<std::uint16_t> best;
        double best_cost = (1 - kLeastGain) * static_cast<double>(count * count);
        std::size_t ended = 0;
        for (std::size_t below = 1; below < count; ++below) {
            const std::uint16_t limit = intervals[below].lower;
            if (limit == intervals[below - 1].lower) continue;
            while (ended < count && uppers_[ended] <= limit) ++ended;
            const std::size_t above = count - ended;
            const auto cost = static_cast<double>(below * below + above * above);
            if (cost >= best_cost) continue;
            best_cost = cost;
            best = limit;
        }
        return best;
    }

    void append_split(const MergedBand& band, std::uint16_t limit, std::int16_t winding_below) {
        append_limit(band.lower, limit, winding_below);
        for (const Interval& interval : band.intervals)
            if (interval.lower < limit) append_reference(interval);
        append_limit(limit, band.upper, ExactMapView::kSplit);
        for (const Interval& interval : band.intervals)
            if (interval.upper > limit) append_reference(interval);
    }

    /// The same, with gaps cut into pieces by bands without faces. A band in which crossings do not tell the
    /// winding number gets such a band right above it, with nothing but an uncertain gap between the two.
    void append_open(std::uint32_t cell) {
        const double whole = l1_at_sphere(cell);
        uncertain_ = 0;
        std::uint16_t lower = 0;
        for (std::size_t b = 0; b < merged_.size(); ++b) {
            const MergedBand& band = merged_[b];
            append(band, append_gap(cell, lower, band.lower, band.winding_below));
            const int beyond = b + 1 < merged_.size() ? merged_[b + 1].winding_below : 0;
            if (!gap_states_->certain_in_band(cell, band.lower, band.upper, beyond)) {
                append_limit(band.upper, band.upper, ExactMapView::kUncertain);
                uncertain_ += volume(band.lower, band.upper, whole);
            }
            lower = band.upper;
        }
        constexpr double kBeyondOtherRays = 1.05; // the middle's is not the longest way to the sphere
        const auto end = static_cast<std::uint16_t>(kBeyondOtherRays * whole / ExactMapView::kBandUnit);
        const std::uint16_t limit = std::max(end, lower);
        append_limit(limit, limit, append_gap(cell, lower, limit, 0)); // beyond it nobody looked
        result_.uncertain_volumes.push_back({uncertain_, whole * whole * whole});
    }

    /// Appends all pieces of a gap but the last, whose winding number is returned.
    std::int16_t append_gap(std::uint32_t cell, std::uint16_t lower, std::uint16_t upper, int crossings) {
        pieces_.clear();
        gap_states_->append_pieces(cell, lower, upper, crossings, pieces_);
        if (pieces_.empty()) return ExactMapView::kUncertain; // a gap without a place in it
        const double whole = l1_at_sphere(cell);
        std::uint16_t piece_lower = lower;
        for (const GapPiece& piece : pieces_) {
            if (piece.winding == ExactMapView::kUncertain)
                uncertain_ += volume(piece_lower, piece.upper, whole);
            if (&piece != &pieces_.back()) append_limit(piece.upper, piece.upper, piece.winding);
            piece_lower = piece.upper;
        }
        return pieces_.back().winding;
    }

    /// Of a cell's cone between two L1 norms, but for a factor that all cells share.
    static double volume(std::uint16_t lower, std::uint16_t upper, double whole) {
        const double low = std::min(whole, static_cast<double>(lower) * ExactMapView::kBandUnit);
        const double high = std::min(whole, static_cast<double>(upper) * ExactMapView::kBandUnit);
        return high * high * high - low * low * low;
    }

    /// The L1 norm at which the ray through a cell's middle leaves the bounding sphere.
    double l1_at_sphere(std::uint32_t cell) const {
        const LatticePoint middle = cells_.middle(cell);
        return static_cast<double>(kLatticeExtent * l1_norm(middle)) / length(Vec3d(middle));
    }

    const LatticeMesh& lattice_;
    const OctahedralCells& cells_;
    const CellIntervals& intervals_;
    const GapStates* gap_states_;
    std::vector<MergedBand> merged_;
    std::vector<GapPiece> pieces_;
    std::vector<std::uint16_t> uppers_;
    double uncertain_ = 0; ///< volume of the cell at hand
    Bands result_;
};

void append_vector(auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Bands of consecutive cells.
struct FoundBands {
    std::size_t first_cell;
    Bands bands;
};

void join(std::vector<FoundBands> found, const OctahedralCells& cells, Bands& all) {
    std::sort(found.begin(), found.end(),
              [](const FoundBands& a, const FoundBands& b) { return a.first_cell < b.first_cell; });
    all.clear();
    all.offsets.reserve(cells.count() + 1);
    all.offsets.push_back(0);
    for (const FoundBands& part : found) {
        const auto first_band = static_cast<std::uint32_t>(all.bands.size());
        const auto first_reference = static_cast<std::uint32_t>(all.references.size());
        for (std::uint32_t offset : part.bands.offsets) all.offsets.push_back(first_band + offset);
        for (const Band& band : part.bands.bands)
            all.bands.push_back({band.lower, band.upper, first_reference + band.first_reference});
        append_vector(all.references, part.bands.references);
        append_vector(all.reference_parts, part.bands.reference_parts);
        append_vector(all.winding_below, part.bands.winding_below);
        append_vector(all.uncertain_volumes, part.bands.uncertain_volumes);
    }
    all.bands.push_back({0, 0, static_cast<std::uint32_t>(all.references.size())});
}

} // namespace

void Bands::clear() {
    offsets.clear();
    bands.clear();
    references.clear();
    reference_parts.clear();
    winding_below.clear();
    uncertain_volumes.clear();
}

void find_bands(const LatticeMesh& lattice, std::span<const BorderEdge> border, const OctahedralCells& cells,
                unsigned thread_count, Bands& result) {
    const CellIntervals intervals = find_intervals(lattice, cells, thread_count);
    std::optional<GapStates> gap_states;
    if (!border.empty()) gap_states.emplace(lattice, border, cells);
    std::vector<FoundBands> found;
    std::mutex mutex;
    parallel_for(cells.count(), thread_count, [&](std::size_t begin, std::size_t end) {
        BandBuilder builder(lattice, cells, intervals, gap_states ? &*gap_states : nullptr);
        for (std::size_t cell = begin; cell < end; ++cell) builder.add_cell(static_cast<std::uint32_t>(cell));
        Bands bands = builder.take();
        const std::lock_guard lock(mutex);
        found.push_back({begin, std::move(bands)});
    });
    join(std::move(found), cells, result);
}

double expected_tests(const Bands& bands) {
    if (bands.references.empty()) return 0;
    double sum_of_squares = 0;
    for (std::size_t band = 0; band + 1 < bands.bands.size(); ++band) {
        const double count = bands.bands[band + 1].first_reference - bands.bands[band].first_reference;
        sum_of_squares += count * count;
    }
    return sum_of_squares / static_cast<double>(bands.references.size());
}

} // namespace echinus
