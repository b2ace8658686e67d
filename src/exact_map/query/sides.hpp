#pragma once

#include "exact_map/layout.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "exact_map/query/winding.hpp"

#include <cmath>
#include <cstdint>
#include <span>

/// On which side of the surface particles lie, by their winding numbers and the map's rule.
namespace echinus {

/// The answer of classify() as bits.
using Side = std::uint8_t;
inline constexpr Side kInsideBit = 1;
inline constexpr Side kUncertainBit = 2;

/// A point with a NaN has no position, so no answer about it is certain.
inline bool has_nan(const Vec3f& point) {
    return std::isnan(point.x) || std::isnan(point.y) || std::isnan(point.z);
}

/// The scalar query, which is the specification.
inline Side side_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) noexcept {
    const Winding winding = winding_at(map, frame, point_local);
    return static_cast<Side>((is_inside(map.rule, winding.number) ? kInsideBit : 0) |
                             (winding.certain ? 0 : kUncertainBit));
}

struct SideAndLeaf {
    Side side;
    std::uint32_t near_leaf; ///< leaf_near(), or kNoLeaf if it was not determined
};

/// side_at() by vector instructions, whose lanes are the faces of one band; for a particle inside, also a
/// leaf near it.
/// @param leaf_outside  whether to find a leaf for a particle outside, too
SideAndLeaf find_side(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                      bool leaf_outside) noexcept;

/// side_at() for many particles, by vector instructions.
/// @pre points_local.size() == sides.size()
void find_sides(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                std::span<Side> sides) noexcept;

} // namespace echinus
