#include "exact_map/spatial_order.hpp"

#include <algorithm>
#include <array>

namespace echinus {

namespace {

constexpr int kBitsPerAxis = 7;

/// Moves the lowest 7 bits apart: bit k goes to 3 k.
std::uint32_t spread(std::uint32_t bits) {
    bits = (bits | bits << 8) & 0x0700F;
    bits = (bits | bits << 4) & 0x430C3;
    return (bits | bits << 2) & 0x49249;
}

std::uint32_t cell_of(double coordinate) {
    constexpr auto kExtent = static_cast<double>(kLatticeExtent);
    constexpr std::uint32_t kCellSize = 2 * kLatticeExtent >> kBitsPerAxis;
    constexpr std::uint32_t kLast = (1U << kBitsPerAxis) - 1;
    const double clamped = std::min(std::max(coordinate, -kExtent), kExtent);
    return std::min(static_cast<std::uint32_t>(clamped + kExtent) / kCellSize, kLast);
}

} // namespace

std::uint32_t morton_key(const Vec3d& place) noexcept {
    return spread(cell_of(place.x)) | spread(cell_of(place.y)) << 1 | spread(cell_of(place.z)) << 2;
}

void sort_by_key(std::span<Station> stations, std::span<Station> spare) noexcept {
    constexpr int kDigitBits = 11;
    constexpr std::uint32_t kMask = (1U << kDigitBits) - 1;
    static_assert(3 * kBitsPerAxis <= 2 * kDigitBits); // so that two passes do
    for (int shift = 0; shift < 2 * kDigitBits; shift += kDigitBits) {
        std::array<std::uint32_t, kMask + 2> starts{};
        for (const Station& station : stations) ++starts[(station.key >> shift & kMask) + 1];
        for (std::size_t digit = 1; digit < starts.size(); ++digit) starts[digit] += starts[digit - 1];
        for (const Station& station : stations) spare[starts[station.key >> shift & kMask]++] = station;
        std::swap(stations, spare);
    }
}

} // namespace echinus
