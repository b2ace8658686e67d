#pragma once

#include "directions/lattice.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A particle and where it is on a curve through the bounding cube.
struct Station {
    std::uint32_t key;
    std::uint32_t particle;
};

/// The number of a place on Morton's curve through cells of 1/64 R: places with near numbers are near each
/// other. Places beyond the lattice count as on its border.
std::uint32_t morton_key(const Vec3d& place) noexcept;

/// Sorts by key; those of one key stay in order. @param spare  as long
void sort_by_key(std::span<Station> stations, std::span<Station> spare) noexcept;

} // namespace echinus
