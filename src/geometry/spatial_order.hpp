#pragma once

#include <echinus/geometry.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A particle and its cell's number on a Morton curve.
struct KeyedParticle {
    std::uint32_t key;
    std::uint32_t particle;
};

/// The Morton curve through the cells of a cube: cells with close numbers are close to each other.
class MortonCurve {
  public:
    static constexpr int kBitsPerAxis = 7;

    /// @param centre, radius  the ball that the cube encloses
    MortonCurve(const Vec3f& centre, float radius);

    /// The number of the cell of a point. A point beyond the cube counts as the point at which its ray from
    /// the centre leaves the cube; NaN has number 0.
    std::uint32_t key(const Vec3f& point_local) const noexcept;

  private:
    static constexpr std::uint32_t kLast = (1U << kBitsPerAxis) - 1; ///< the last cell of a row

    Vec3f centre_;
    float radius_, cells_per_unit_;
};

/// Sorts by key, stably. @param spare  temporary memory, as long as `particles`
void sort_by_key(std::span<KeyedParticle> particles, std::span<KeyedParticle> spare) noexcept;

} // namespace echinus
