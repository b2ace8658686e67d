#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// Points of the unit square, in [0, 1)^2.
using Sample2 = std::array<float, 2>;

/// The purpose of a pair of random numbers; each has its own sequence.
enum class SampleUse : std::uint32_t { Pixel, Lamp, Sky };

/// Evenly spread points of the unit square for the samples of every pixel: Owen-scrambled Sobol sequences
/// (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020), in which any aligned run of 2^k points
/// lies as evenly as points can. A few sequences are tabulated; each pixel takes one of them and flips its
/// digits by the pixel's own pattern, which preserves the even distribution at almost no cost.
class SampleTables {
  public:
    explicit SampleTables(std::uint32_t sample_count);

    /// The scrambling of a pixel's samples.
    static std::uint32_t pixel_seed(std::uint32_t x, std::uint32_t y);

    /// @pre sample < sample_count
    Sample2 sample(std::uint32_t sample, SampleUse use, std::uint32_t pixel_seed) const;

  private:
    using Bits2 = std::array<std::uint32_t, 2>;

    std::uint32_t sample_count_;
    std::vector<Bits2> points_; ///< [kTableCount][sample_count]
};

} // namespace echinus
