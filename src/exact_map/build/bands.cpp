#include "exact_map/build/bands.hpp"

#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <mutex>
#include <optional>

namespace echinus {

namespace {

constexpr std::size_t kBytesPerBand = sizeof(Band) + sizeof(std::int16_t);
constexpr std::size_t kBytesPerCell = sizeof(std::uint32_t) + sizeof(std::uint16_t);
/// The bytes of the last offset and of the sentinel that ends the bands.
constexpr std::size_t kBytesOfEnds = sizeof(std::uint32_t) + sizeof(Band);

/// Keeps the numbers of bands within 31 bits. Those of references are, since an interval gives at most two.
constexpr std::size_t kMostBytes = std::min<std::uint64_t>(std::uint64_t{kBytesPerBand} << 31, SIZE_MAX);
static_assert(2 * BandFinder::kMostIntervals < std::size_t{1} << 31);

/// The bytes of a reference, including the parts of the cell that its face touches.
std::size_t bytes_per_reference(std::size_t face_count) {
    return IndexStorage::bytes_per_number(face_count) + sizeof(std::uint16_t);
}

/// Intervals take several times the memory of the references that they become. If there may be many, the
/// octants are therefore processed one after the other, so that only the intervals of one are in memory at a
/// time; otherwise it is not worth starting the threads eight times.
/// @param most_intervals  an upper bound for all octants together
std::uint32_t octants_at_a_time(std::size_t most_intervals, std::size_t face_count, std::size_t cell_count) {
    constexpr std::size_t kMany = std::size_t{1} << 21;
    constexpr std::size_t kCellsPerFace = 16; // long faces that lie close together cross one cell in 16
    return std::min(most_intervals, face_count * cell_count / kCellsPerFace) > kMany ? 1 : 8;
}

} // namespace

bool BandFinder::find(const LatticeMesh& lattice, const ExactMapView& surface, const BandDetail& detail,
                      unsigned thread_count, std::size_t byte_limit, Bands& result) {
    const OctahedralCells& cells = detail.cells;
    byte_limit = std::min(byte_limit, kMostBytes);
    const std::size_t bytes_of_cells = cells.count() * kBytesPerCell + kBytesOfEnds;
    if (bytes_of_cells > byte_limit) return false;
    const std::size_t reference_bytes = bytes_per_reference(lattice.faces.size());
    LimitedCount byte_count(byte_limit - bytes_of_cells);
    const std::size_t most_intervals =
        std::min((byte_limit - bytes_of_cells) / reference_bytes, kMostIntervals);
    LimitedCount interval_count(most_intervals);
    std::optional<GapStates> gap_states;
    if (!surface.border.empty()) gap_states.emplace(surface, cells, detail.gap_halvings);
    lists_.resize(worker_count(thread_count));
    for (BandList& list : lists_) list.clear();
    blocks_.clear();
    const std::uint32_t step = octants_at_a_time(most_intervals, lattice.faces.size(), cells.count());
    for (std::uint32_t octant = 0; octant < 8; octant += step) {
        if (!intervals_.find(lattice, cells, {octant, octant + step}, thread_count, interval_count))
            return false;
        find_blocks(gap_states ? &*gap_states : nullptr, cells, thread_count, reference_bytes, byte_count);
        if (byte_count.exceeded()) return false;
    }
    std::sort(blocks_.begin(), blocks_.end(),
              [](const Block& a, const Block& b) { return a.first_cell < b.first_cell; });
    make_room(cells.count(), lattice.faces.size(), result);
    parallel_for(blocks_.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) copy(blocks_[block], result);
    });
    return true;
}

/// Finds the bands of the cells whose intervals have been found.
void BandFinder::find_blocks(const GapStates* gap_states, const OctahedralCells& cells, unsigned thread_count,
                             std::size_t bytes_per_reference, LimitedCount& byte_count) {
    const std::size_t cell_count = intervals_.cell_count();
    for (BandList& list : lists_)
        list.make_room(intervals_.count() / lists_.size(), cell_count / lists_.size());
    std::mutex mutex;
    parallel_for_workers(
        cell_count, thread_count, [&](std::size_t worker, std::size_t begin, std::size_t end) {
            BandList& list = lists_[worker];
            Block block{worker,
                        intervals_.first_cell() + begin,
                        end - begin,
                        list.band_counts.size(),
                        list.bands.size(),
                        0,
                        list.references.size(),
                        0,
                        list.volumes.size(),
                        0,
                        0};
            CountShare bytes(byte_count);
            BandBuilder builder(cells, gap_states, list);
            for (std::size_t i = 0; i < block.cell_count; ++i) {
                const auto cell = kept_as<std::uint32_t>(block.first_cell + i);
                const std::size_t bands = list.bands.size(), references = list.references.size();
                builder.add_cell(cell, intervals_.of(cell));
                if (!bytes.add((list.bands.size() - bands) * kBytesPerBand +
                               (list.references.size() - references) * bytes_per_reference))
                    return;
            }
            block.band_count = list.bands.size() - block.first_band;
            block.reference_count = list.references.size() - block.first_reference;
            const std::lock_guard lock(mutex);
            blocks_.push_back(block);
        });
}

void BandFinder::make_room(std::size_t cell_count, std::size_t face_count, Bands& result) {
    std::size_t band_count = 0, reference_count = 0, volume_count = 0;
    for (Block& block : blocks_) {
        block.to_band = band_count;
        block.to_reference = reference_count;
        band_count += block.band_count;
        reference_count += block.reference_count;
    }
    for (const BandList& list : lists_) volume_count += list.volumes.size();
    result.offsets.reset(cell_count + 1);
    result.bands.reset(band_count + 1);
    result.winding_below.reset(band_count);
    result.references.reset(reference_count, face_count);
    result.reference_parts.reset(reference_count);
    result.volumes.reset(volume_count);
    result.offsets[cell_count] = kept_as<std::uint32_t>(band_count);
    result.bands[band_count] = {0, 0, kept_as<std::uint32_t>(reference_count)};
}

void BandFinder::copy(const Block& block, Bands& result) const {
    const BandList& list = lists_[block.worker];
    auto offset = kept_as<std::uint32_t>(block.to_band);
    for (std::size_t i = 0; i < block.cell_count; ++i) {
        result.offsets[block.first_cell + i] = offset;
        offset += list.band_counts[block.first_count + i];
    }
    const auto moved = static_cast<std::uint32_t>(block.to_reference - block.first_reference); // modulo 2^32
    for (std::size_t i = 0; i < block.band_count; ++i) {
        const Band& band = list.bands[block.first_band + i];
        result.bands[block.to_band + i] = {band.lower, band.upper, band.first_reference + moved};
    }
    std::copy_n(list.winding_below.data() + block.first_band, block.band_count,
                result.winding_below.data() + block.to_band);
    std::copy_n(list.reference_parts.data() + block.first_reference, block.reference_count,
                result.reference_parts.data() + block.to_reference);
    result.references.with_numbers([&]<typename Number>(Number* numbers) {
        std::transform(list.references.data() + block.first_reference,
                       list.references.data() + block.first_reference + block.reference_count,
                       numbers + block.to_reference,
                       [](std::uint32_t face) { return static_cast<Number>(face); });
    });
    if (result.volumes.empty()) return;
    std::copy_n(list.volumes.data() + block.first_volume, block.cell_count,
                result.volumes.data() + block.first_cell);
}

std::size_t byte_count(const Bands& bands) {
    return kBytesOfEnds + (bands.offsets.size() - 1) * kBytesPerCell +
           (bands.bands.size() - 1) * kBytesPerBand + bands.references.view().size_bytes() +
           bands.reference_parts.size() * sizeof(std::uint16_t);
}

double expected_tests(const Bands& bands) {
    if (bands.references.size() == 0) return 0;
    double sum_of_squares = 0;
    for (std::size_t band = 0; band + 1 < bands.bands.size(); ++band) {
        const double count = bands.bands[band + 1].first_reference - bands.bands[band].first_reference;
        sum_of_squares += count * count;
    }
    return sum_of_squares / static_cast<double>(bands.references.size());
}

} // namespace echinus
