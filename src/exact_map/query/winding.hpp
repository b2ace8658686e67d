#pragma once

#include "directions/lattice.hpp"
#include "exact_map/query/winding_tree.hpp"

#include <echinus/exact_map_view.hpp>

#include <cmath>
#include <cstdint>

namespace echinus {

/// The signed crossings, counted as by crossing_on(), of the ray from the origin through a particle with the
/// caps of the border, beyond the particle. Visits the nodes whose boxes the ray meets.
/// @pre the map's winding tree holds caps
int cap_crossings(const ExactMapView& map, const LatticePoint& p) noexcept;

/// The winding number of the surface around a place.
struct Winding {
    std::int64_t number = 0; ///< for an open surface, the generalised winding number, rounded
    bool certain = true; ///< whether the number is at least kCertainMargin away from the values at which the
                         ///< answer changes
    bool computed = false; ///< whether it was computed for this place, as is usual for an open surface
};

/// Is a place, in lattice steps, rounded to a point of the lattice?
inline bool is_on_lattice(const Vec3d& place) {
    constexpr double kLimit = static_cast<double>(kLatticeExtent) + 0.5;
    return (std::fabs(place.x) <= kLimit) & (std::fabs(place.y) <= kLimit) & (std::fabs(place.z) <= kLimit);
}

/// The values of the winding number at which the map's rule changes the side.
inline WindingGoal::Turn turn_of_side(const ExactMapView& map) {
    return map.rule == InsideRule::Nonzero ? WindingGoal::Turn::AtOneHalf : WindingGoal::Turn::AtEveryHalf;
}

/// The winding number around a particle, as accurate as its side requires. This scalar code is the
/// specification of inside and outside.
Winding winding_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) noexcept;

/// The same for a point of the lattice, or a few steps beyond it.
Winding winding_at(const ExactMapView& map, const LatticePoint& p, WindingGoal::Turn turn) noexcept;
inline Winding winding_at(const ExactMapView& map, const LatticePoint& p) noexcept {
    return winding_at(map, p, turn_of_side(map));
}

/// The generalised winding number around a particle, not rounded.
/// @param tolerance  the largest error; it never moves the number across a half
double winding_number_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                         double tolerance) noexcept;

} // namespace echinus
