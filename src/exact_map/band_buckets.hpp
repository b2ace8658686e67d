#pragma once

#include <echinus/geometry.hpp>

#include <hwy/cache_control.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace echinus {

/// A particle in a band: the faces of the band must tell whether it is inside.
struct Unsettled {
    Vec3f point_local;
    std::uint32_t particle;
    std::uint32_t place; ///< the band, shifted, and kOutermost where it is its cell's last

    static constexpr std::uint32_t kOutermost = 1;
    static constexpr int kBandShift = 1;

    std::uint32_t band() const { return place >> kBandShift; }
    bool outermost() const { return (place & kOutermost) != 0; }
};

/// Collects unsettled particles so that those of one band are met together, and the band's faces are prepared
/// once for all of them. Neighbouring bands share a bucket; a full one is sorted and handed out. So what is
/// worked on at a time, particles and faces, fits into the second-level cache however large the batch is.
class BandBuckets {
  public:
    /// @param band_count      all bands are below it
    /// @param particle_count  of the batch
    /// @throws std::bad_alloc
    BandBuckets(std::size_t band_count, std::size_t particle_count);

    std::size_t count() const { return sizes_.size(); }

    static constexpr std::size_t kAhead = 8;

    /// Returns the bucket that the particle went to.
    std::size_t add(const Unsettled& particle) {
        const std::size_t bucket = particle.band() >> band_shift_;
        Unsettled* place = &found_[bucket * capacity_ + sizes_[bucket]++];
        *place = particle;
        hwy::Prefetch(place + kAhead); // of its bucket the next to be written
        return bucket;
    }
    bool is_full(std::size_t bucket) const { return sizes_[bucket] == capacity_; }

    /// The particles of a bucket, by band; the bucket is then empty.
    std::span<const Unsettled> take(std::size_t bucket);

  private:
    std::size_t capacity_; ///< of a bucket
    int band_shift_;
    int slot_shift_ = 0; ///< neighbouring bands are sorted together first where a bucket has very many
    std::unique_ptr<Unsettled[]> found_, sorted_;
    std::vector<std::uint32_t> sizes_;
    std::vector<std::uint32_t> starts_;
};

} // namespace echinus
