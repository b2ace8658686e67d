#pragma once

#include <echinus/geometry.hpp>

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

/// Morton's curve through the cells of a cube: places with near numbers are near each other.
class MortonCurve {
  public:
    static constexpr int kBitsPerAxis = 7;

    /// @param centre, radius  of the ball in the cube
    MortonCurve(const Vec3f& centre, float radius);

    /// The number of a place's cell. Places beyond the cube count as on its border, and NaN as 0.
    std::uint32_t key(const Vec3f& point_local) const noexcept;

  private:
    static constexpr std::uint32_t kLast = (1U << kBitsPerAxis) - 1; ///< cell of a row

    Vec3f low_;
    float cells_per_unit_;
};

/// Sorts by key; those of one key stay in order. @param spare  as long
void sort_by_key(std::span<Station> stations, std::span<Station> spare) noexcept;

} // namespace echinus
