#include "exact_map/build/band_builder.hpp"

#include "geometry/whole_numbers.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

std::int16_t stored_winding(int winding) {
    if (winding > std::numeric_limits<std::int16_t>::max() ||
        winding < -std::numeric_limits<std::int16_t>::max() + 1)
        throw Error(ErrorCode::InvalidMesh, "the surface winds around a point more than 32766 times");
    return static_cast<std::int16_t>(winding);
}

int sum_of_crossings(std::span<const Interval> intervals) {
    int sum = 0;
    for (const Interval& interval : intervals) sum += interval.crossing;
    return sum;
}

/// The volume of a cell's cone between two L1 norms, up to a common factor.
double volume(std::uint16_t lower, std::uint16_t upper, double whole) {
    const double low = std::min(whole, static_cast<double>(lower) * ExactMapView::kBandUnit);
    const double high = std::min(whole, static_cast<double>(upper) * ExactMapView::kBandUnit);
    return high * high * high - low * low * low;
}

} // namespace

void BandList::clear() {
    band_counts.clear();
    bands.clear();
    winding_below.clear();
    references.clear();
    reference_parts.clear();
    volumes.clear();
}

void BandList::make_room(std::size_t interval_count, std::size_t cell_count) {
    const std::size_t reference_count = interval_count + interval_count / 2; // some are listed twice
    const std::size_t band_count = 4 * cell_count;
    band_counts.room_for(cell_count);
    bands.room_for(band_count);
    winding_below.room_for(band_count);
    references.room_for(reference_count);
    reference_parts.room_for(reference_count);
}

std::span<const Interval> IntervalSorter::sorted(std::span<Interval> intervals) {
    if (intervals.size() <= 1) return intervals;
    if (intervals.size() <= kFew) return ranked(intervals);
    std::sort(intervals.begin(), intervals.end(),
              [](const Interval& a, const Interval& b) { return a.key < b.key; });
    return intervals;
}

/// Sorts by counting, for each interval, how many come before it. This compares all pairs, but without a
/// branch that a processor could mispredict; for short lists, which most are, it is faster than other sorting
/// methods.
std::span<const Interval> IntervalSorter::ranked(std::span<const Interval> intervals) {
    std::array<std::uint32_t, kFew> rank;
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        const std::uint64_t key = intervals[i].key;
        std::uint32_t smaller = 0;
        for (std::size_t k = 0; k < i; ++k) {
            const std::uint32_t is_smaller = intervals[k].key < key ? 1 : 0;
            smaller += is_smaller;
            rank[k] += 1 - is_smaller;
        }
        rank[i] = smaller;
    }
    for (std::size_t i = 0; i < intervals.size(); ++i) sorted_[rank[i]] = intervals[i];
    return std::span(sorted_).first(intervals.size());
}

void BandBuilder::add_cell(std::uint32_t cell, std::span<Interval> intervals) {
    const std::size_t band_count = result_.bands.size();
    merge(sorter_.sorted(intervals));
    if (gap_states_ == nullptr)
        append_closed();
    else
        append_open(cell);
    result_.band_counts.push_back(kept_as<std::uint32_t>(result_.bands.size() - band_count));
}

/// Merges intervals that overlap or touch, and counts the crossings of the middle ray.
void BandBuilder::merge(std::span<const Interval> rest) {
    merged_.clear();
    while (!rest.empty()) {
        std::uint16_t upper = rest.front().upper();
        std::size_t count = 1;
        for (; count < rest.size() && rest[count].lower() <= upper; ++count)
            upper = std::max(upper, rest[count].upper());
        merged_.push_back({rest.front().lower(), upper, rest.first(count), 0});
        rest = rest.subspan(count);
    }
    int winding = 0;
    for (std::size_t band = merged_.size(); band-- > 0;) {
        winding += sum_of_crossings(merged_[band].intervals);
        merged_[band].winding_below = winding;
    }
}

void BandBuilder::append(const MergedBand& band, std::int16_t winding_below) {
    append_limit(band.lower, band.upper, winding_below);
    append_references(band.intervals, [](const Interval&) { return true; });
}

/// Appends the faces of a band, except those seen edge-on. Each face is written first and then kept or not,
/// so that no branch can be mispredicted.
template <typename Belongs>
void BandBuilder::append_references(std::span<const Interval> intervals, const Belongs& belongs) {
    std::uint32_t* faces = result_.references.room_for(intervals.size());
    std::uint16_t* parts = result_.reference_parts.room_for(intervals.size());
    std::size_t count = 0;
    for (const Interval& interval : intervals) {
        faces[count] = interval.face();
        parts[count] = interval.parts;
        count += static_cast<std::size_t>(belongs(interval)) & static_cast<std::size_t>(!interval.edge_on);
    }
    result_.references.extend(count);
    result_.reference_parts.extend(count);
}

void BandBuilder::append_limit(std::uint16_t lower, std::uint16_t upper, std::int16_t winding_below) {
    result_.bands.push_back({lower, upper, kept_as<std::uint32_t>(result_.references.size())});
    result_.winding_below.push_back(winding_below);
}

void BandBuilder::append_closed() {
    for (const MergedBand& band : merged_) {
        const std::int16_t winding_below = stored_winding(band.winding_below);
        if (const std::optional<std::uint16_t> limit = split_of(band.intervals))
            append_split(band, *limit, winding_below);
        else
            append(band, winding_below);
    }
}

/// Where to cut a band in two, so that a query needs only the faces of its half: those of the lower half give
/// the ray's crossings before the particle, those of the upper half the crossings beyond it. Faces in both
/// halves are listed twice.
std::optional<std::uint16_t> BandBuilder::split_of(std::span<const Interval> intervals) {
    constexpr std::size_t kLeastFaces = 6;
    constexpr double kLeastGain = 0.3; // share of the cost; for less, memory is better spent on more cells
    const std::size_t count = intervals.size();
    if (count < kLeastFaces) return std::nullopt;
    double best_cost = (1 - kLeastGain) * static_cast<double>(count * count);

    // Consider the highest cut with few enough faces below: if too many reach beyond it, no cut will do.
    const auto most_below = std::min(count - 1, truncated_to<std::size_t>(std::sqrt(best_cost)));
    const std::uint16_t highest = intervals[most_below].lower();
    std::size_t least_above = 0;
    for (const Interval& interval : intervals) least_above += interval.upper() > highest ? 1 : 0;
    if (static_cast<double>(least_above * least_above) >= best_cost) return std::nullopt;

    uppers_.clear();
    for (const Interval& interval : intervals) uppers_.push_back(interval.upper());
    std::sort(uppers_.begin(), uppers_.end());
    std::optional<std::uint16_t> best;
    std::size_t ended = 0;
    for (std::size_t below = 1; below <= most_below; ++below) {
        const std::uint16_t limit = intervals[below].lower();
        if (limit == intervals[below - 1].lower()) continue;
        while (ended < count && uppers_[ended] <= limit) ++ended;
        const std::size_t above = count - ended;
        const auto cost = static_cast<double>(below * below + above * above);
        if (cost >= best_cost) continue;
        best_cost = cost;
        best = limit;
    }
    return best;
}

void BandBuilder::append_split(const MergedBand& band, std::uint16_t limit, std::int16_t winding_below) {
    append_limit(band.lower, limit, winding_below);
    append_references(band.intervals, [=](const Interval& interval) { return interval.lower() < limit; });
    append_limit(limit, band.upper, ExactMapView::kSplit);
    append_references(band.intervals, [=](const Interval& interval) { return interval.upper() > limit; });
}

/// Appends the bands of a cell of an open surface. Bands without faces cut the gaps into pieces. If crossings
/// do not determine the winding number in a band, such a band follows directly above it, with only an
/// uncertain gap between the two.
void BandBuilder::append_open(std::uint32_t cell) {
    const double whole = l1_at_sphere(cell);
    uncertain_ = 0;
    std::uint16_t lower = 0;
    for (std::size_t b = 0; b < merged_.size(); ++b) {
        const MergedBand& band = merged_[b];
        append(band, append_gap(cell, lower, band.lower, band.winding_below));
        if (!gap_states_->certain_in_band(cell, {lower, band.lower, band.winding_below}, band.upper)) {
            append_limit(band.upper, band.upper, ExactMapView::kUncertain);
            uncertain_ += volume(band.lower, band.upper, whole);
        }
        lower = band.upper;
    }
    // Other rays of the cell may reach the sphere at a larger norm than the middle one.
    constexpr double kBeyondOtherRays = 1.05;
    const auto end = truncated_to<std::uint16_t>(kBeyondOtherRays * whole / ExactMapView::kBandUnit);
    const std::uint16_t limit = std::max(end, lower);
    append_limit(limit, limit, append_gap(cell, lower, limit, 0)); // nothing was examined beyond it
    result_.volumes.push_back({uncertain_, whole * whole * whole});
}

/// Appends all pieces of a gap except the last, whose winding number it returns.
std::int16_t BandBuilder::append_gap(std::uint32_t cell, std::uint16_t lower, std::uint16_t upper,
                                     int crossings) {
    pieces_.clear();
    gap_states_->append_pieces(cell, {lower, upper, crossings}, pieces_);
    if (pieces_.empty()) return ExactMapView::kUncertain; // a gap without lattice points on the ray
    const double whole = l1_at_sphere(cell);
    std::uint16_t piece_lower = lower;
    for (const GapPiece& piece : pieces_) {
        if (piece.winding == ExactMapView::kUncertain) uncertain_ += volume(piece_lower, piece.upper, whole);
        if (&piece != &pieces_.back()) append_limit(piece.upper, piece.upper, piece.winding);
        piece_lower = piece.upper;
    }
    return pieces_.back().winding;
}

/// The L1 norm at which the ray through a cell's middle leaves the bounding sphere.
double BandBuilder::l1_at_sphere(std::uint32_t cell) const {
    const LatticePoint middle = cells_.middle(cell);
    return static_cast<double>(kLatticeExtent * l1_norm(middle)) / length(Vec3d(middle));
}

} // namespace echinus
