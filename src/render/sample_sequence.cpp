#include "render/sample_sequence.hpp"

namespace echinus {

namespace {

std::uint32_t mix(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

std::uint32_t combine(std::uint32_t seed, std::uint32_t value) {
    return mix(seed ^ (value + 0x9e3779b9U + (seed << 6) + (seed >> 2)));
}

std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    x = ((x >> 8) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8);
    return (x >> 16) | (x << 16);
}

/// Each bit of the result depends only on the bits above it, which preserves the strata (Burley, section 3;
/// constants of Laine and Karras as he gives them).
std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x += seed;
    x ^= x * 0x6c50b47cU;
    x ^= x * 0xb82f1e52U;
    x ^= x * 0xc7afe638U;
    x ^= x * 0x8d22f6e6U;
    return reverse_bits(x);
}

/// Second dimension of the Sobol sequence; the first is the reversed index.
std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 0x80000000U; index != 0; index >>= 1, direction ^= direction >> 1) {
        if ((index & 1U) != 0) result ^= direction;
    }
    return result;
}

/// The upper 24 bits, so that the quotient is exact and below 1.
float to_unit(std::uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24F;
}

constexpr std::uint32_t kTableCount = 64;

} // namespace

SampleTables::SampleTables(std::uint32_t sample_count) : sample_count_(sample_count) {
    points_.reserve(std::size_t{kTableCount} * sample_count);
    for (std::uint32_t table = 0; table < kTableCount; ++table) {
        const std::uint32_t seed = mix(table + 1);
        for (std::uint32_t i = 0; i < sample_count; ++i) {
            const std::uint32_t index = owen_scramble(i, seed);
            points_.push_back({owen_scramble(reverse_bits(index), combine(seed, 1)),
                               owen_scramble(sobol_second(index), combine(seed, 2))});
        }
    }
}

std::uint32_t SampleTables::pixel_seed(std::uint32_t x, std::uint32_t y) {
    return combine(mix(x), y);
}

Sample2 SampleTables::sample(std::uint32_t sample, SampleUse use, std::uint32_t pixel_seed) const {
    const std::uint32_t flips_x = combine(pixel_seed, static_cast<std::uint32_t>(use));
    const std::uint32_t flips_y = mix(flips_x);
    const Bits2& point = points_[std::size_t{flips_x % kTableCount} * sample_count_ + sample];
    return {to_unit(point[0] ^ flips_x), to_unit(point[1] ^ flips_y)};
}

} // namespace echinus
