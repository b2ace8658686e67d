#pragma once

#include "directions/lattice.hpp"
#include "exact_map/query/winding_tree.hpp"

#include <echinus/exact_map_view.hpp>

#include <cmath>
#include <cstdint>

namespace echinus {

/// Signed crossings of the ray from the origin through a particle with the caps of the border, beyond the
/// particle, as crossing_on() counts them. Visits the nodes whose boxes the ray meets.
/// @pre the map's winding tree holds caps
int cap_crossings(const ExactMapView& map, const LatticePoint& p) noexcept;

/// How often the surface winds around a place.
struct Winding {
    std::int64_t number = 0; ///< of an open surface the generalised winding number, rounded
    bool certain = true;     ///< which is at least kCertainMargin away from where the answer turns
    bool computed = false;   ///< for this place, as an open surface's mostly has to be
};

/// Is this place, in lattice steps, rounded into the lattice?
inline bool is_on_lattice(const Vec3d& place) {
    constexpr double kLimit = static_cast<double>(kLatticeExtent) + 0.5;
    return (std::fabs(place.x) <= kLimit) & (std::fabs(place.y) <= kLimit) & (std::fabs(place.z) <= kLimit);
}

/// Where the side turns by the map's rule.
inline WindingGoal::Turn turn_of_side(const ExactMapView& map) {
    return map.rule == InsideRule::Nonzero ? WindingGoal::Turn::AtOneHalf : WindingGoal::Turn::AtEveryHalf;
}

/// The winding number around a particle, as exact as its side needs it to be. This scalar code is the
/// specification of inside and outside.
Winding winding_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) noexcept;

/// The same for a place of the lattice, or a few steps beyond it
Winding winding_at(const ExactMapView& map, const LatticePoint& p, WindingGoal::Turn turn) noexcept;
inline Winding winding_at(const ExactMapView& map, const LatticePoint& p) noexcept {
    return winding_at(map, p, turn_of_side(map));
}

/// The generalised winding number around a particle, not rounded.
/// @param tolerance  it may be off by this much, but not to the other side of a half
double winding_number_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                         double tolerance) noexcept;

} // namespace echinus
