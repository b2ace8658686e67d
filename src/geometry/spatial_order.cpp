#include "geometry/spatial_order.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus {

namespace {

/// Spreads bits: bit k moves to bit 3 k. @param bits  a number of MortonCurve::kBitsPerAxis bits
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | bits << 8) & 0x0700F;
    bits = (bits | bits << 4) & 0x430C3;
    return (bits | bits << 2) & 0x49249;
}

} // namespace

MortonCurve::MortonCurve(const Vec3f& centre, float radius)
    : centre_(centre), radius_(radius), cells_per_unit_((kLast + 1) / (2 * radius)) {}

std::uint32_t MortonCurve::key(const Vec3f& point_local) const noexcept {
    const Vec3f offset = point_local - centre_;
    const float largest = std::max({std::fabs(offset.x), std::fabs(offset.y), std::fabs(offset.z)});
    const float scale = largest > radius_ ? radius_ / largest * cells_per_unit_ : cells_per_unit_;
    const auto cell = [&](float coordinate) {
        const float place = coordinate * scale + 0.5F * (kLast + 1);
        return truncated_to<std::uint32_t>(std::min(std::max(0.0F, place), static_cast<float>(kLast)));
    };
    return spread(cell(offset.x)) | spread(cell(offset.y)) << 1 | spread(cell(offset.z)) << 2;
}

void sort_by_key(std::span<KeyedParticle> particles, std::span<KeyedParticle> spare) noexcept {
    constexpr int kDigitBits = 11;
    constexpr std::uint32_t kMask = (1U << kDigitBits) - 1;
    static_assert(3 * MortonCurve::kBitsPerAxis <= 2 * kDigitBits); // so that two passes suffice
    for (int shift = 0; shift < 2 * kDigitBits; shift += kDigitBits) {
        std::array<std::uint32_t, kMask + 2> starts{};
        for (const KeyedParticle& particle : particles) ++starts[(particle.key >> shift & kMask) + 1];
        for (std::size_t digit = 1; digit < starts.size(); ++digit) starts[digit] += starts[digit - 1];
        for (const KeyedParticle& particle : particles)
            spare[starts[particle.key >> shift & kMask]++] = particle;
        std::swap(particles, spare);
    }
}

} // namespace echinus
