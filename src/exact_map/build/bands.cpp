#include "exact_map/build/bands.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <optional>

namespace echinus {

void BandFinder::find(const LatticeMesh& lattice, std::span<const BorderEdge> border,
                      const OctahedralCells& cells, unsigned thread_count, Bands& result) {
    intervals_.find(lattice, cells, thread_count);
    find_blocks(border, lattice, cells, thread_count);
    make_room(cells.count(), lattice.faces.size(), result);
    parallel_for(blocks_.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) copy(blocks_[block], result);
    });
}

void BandFinder::find_blocks(std::span<const BorderEdge> border, const LatticeMesh& lattice,
                             const OctahedralCells& cells, unsigned thread_count) {
    std::optional<GapStates> gap_states;
    if (!border.empty()) gap_states.emplace(lattice, border, cells);
    lists_.resize(worker_count(thread_count));
    for (BandList& list : lists_)
        list.clear(intervals_.count() / lists_.size(), cells.count() / lists_.size());
    blocks_.clear();
    std::mutex mutex;
    parallel_for_workers(cells.count(), thread_count,
                         [&](std::size_t worker, std::size_t begin, std::size_t end) {
                             BandList& list = lists_[worker];
                             Block block{worker,
                                         begin,
                                         end - begin,
                                         list.band_counts.size(),
                                         list.bands.size(),
                                         0,
                                         list.references.size(),
                                         0,
                                         list.volumes.size(),
                                         0,
                                         0};
                             BandBuilder builder(cells, gap_states ? &*gap_states : nullptr, list);
                             for (std::size_t cell = begin; cell < end; ++cell)
                                 builder.add_cell(static_cast<std::uint32_t>(cell),
                                                  intervals_.of(static_cast<std::uint32_t>(cell)));
                             block.band_count = list.bands.size() - block.first_band;
                             block.reference_count = list.references.size() - block.first_reference;
                             const std::lock_guard lock(mutex);
                             blocks_.push_back(block);
                         });
    std::sort(blocks_.begin(), blocks_.end(),
              [](const Block& a, const Block& b) { return a.first_cell < b.first_cell; });
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
    result.offsets[cell_count] = static_cast<std::uint32_t>(band_count);
    result.bands[band_count] = {0, 0, static_cast<std::uint32_t>(reference_count)};
}

void BandFinder::copy(const Block& block, Bands& result) const {
    const BandList& list = lists_[block.worker];
    auto offset = static_cast<std::uint32_t>(block.to_band);
    for (std::size_t i = 0; i < block.cell_count; ++i) {
        result.offsets[block.first_cell + i] = offset;
        offset += list.band_counts[block.first_count + i];
    }
    const auto moved = static_cast<std::uint32_t>(block.to_reference - block.first_reference);
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
