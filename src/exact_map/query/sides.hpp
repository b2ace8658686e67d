#pragma once

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <span>

/// contains() and classify() for many particles: vector instructions settle those in gaps, and test pairs of
/// a particle and a face for those in bands.
namespace echinus {

/// What classify() says, in bits.
using Side = std::uint8_t;
inline constexpr Side kInsideBit = 1;
inline constexpr Side kUncertainBit = 2;

inline Side side_of(const Containment& containment) {
    return static_cast<Side>((containment.inside ? kInsideBit : 0) |
                             (containment.certain ? 0 : kUncertainBit));
}

/// The side of every particle; the same as by classify(), whatever the instruction set.
/// Cost: takes 90 KB of the stack for 8 particles and more.
/// @pre points_local.size() == sides.size()
void find_sides(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                std::span<Side> sides) noexcept;

} // namespace echinus
