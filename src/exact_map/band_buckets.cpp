#include "exact_map/band_buckets.hpp"

#include <algorithm>
#include <bit>

namespace echinus {

namespace {

constexpr int kMostBucketsBits = 6;         // 64 buckets are written to in turn
constexpr int kMostSlotsBits = 11;          // of a bucket's counting sort
constexpr std::size_t kMostInBucket = 4000; // 80 KB
constexpr std::size_t kFewestInBucket = 64;

int excess_bits(std::size_t count, int bits) {
    return std::max(0, static_cast<int>(std::bit_width(count)) - bits);
}

} // namespace

BandBuckets::BandBuckets(std::size_t band_count, std::size_t particle_count)
    : capacity_(std::clamp(particle_count / 16, kFewestInBucket, kMostInBucket)),
      band_shift_(excess_bits(band_count, kMostBucketsBits)),
      slot_shift_(std::max(0, band_shift_ - kMostSlotsBits)), sizes_((band_count >> band_shift_) + 1),
      starts_((std::size_t{1} << (band_shift_ - slot_shift_)) + 1) {
    found_ = std::make_unique_for_overwrite<Unsettled[]>(capacity_ * sizes_.size());
    sorted_ = std::make_unique_for_overwrite<Unsettled[]>(capacity_);
}

std::span<const Unsettled> BandBuckets::take(std::size_t bucket) {
    const std::span<const Unsettled> found(&found_[bucket * capacity_], sizes_[bucket]);
    sizes_[bucket] = 0;
    const std::uint32_t first_band = static_cast<std::uint32_t>(bucket) << band_shift_;
    const auto slot = [&](const Unsettled& particle) {
        return (particle.band() - first_band) >> slot_shift_;
    };
    std::fill(starts_.begin(), starts_.end(), 0);
    for (const Unsettled& particle : found) ++starts_[slot(particle) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    for (const Unsettled& particle : found) sorted_[starts_[slot(particle)]++] = particle;
    if (slot_shift_ > 0)
        std::sort(&sorted_[0], &sorted_[0] + found.size(),
                  [](const Unsettled& a, const Unsettled& b) { return a.place < b.place; });
    return {sorted_.get(), found.size()};
}

} // namespace echinus
