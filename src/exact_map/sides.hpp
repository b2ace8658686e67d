#pragma once

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <span>

/// contains() and classify() for many particles: vector instructions settle those in gaps, gather those in
/// bands, and test the faces of one band after the other.
namespace echinus {

/// What classify() says, in bits.
using Side = std::uint8_t;
inline constexpr Side kInside = 1;
inline constexpr Side kUncertain = 2;

inline Side side_of(const Containment& containment) {
    return static_cast<Side>((containment.inside ? kInside : 0) | (containment.certain ? 0 : kUncertain));
}

/// The side of every particle; the same as by classify(), whatever the instruction set.
/// Cost: for 512 particles and more, allocates up to 160 bytes a particle, at most 6 MB; where there is no
/// memory, the reference answers.
/// @pre points_local.size() == sides.size()
void find_sides(const ExactMapView& map, StridedSpan<const Vec3f> points_local,
                std::span<Side> sides) noexcept;

} // namespace echinus
