#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

namespace echinus {

/// Signed crossings of the ray from the origin through a particle with the caps of the border, beyond the
/// particle, as crossing_on() counts them. Visits the nodes whose boxes the ray meets.
/// @pre the map's winding tree holds caps
int cap_crossings(const ExactMapView& map, const LatticePoint& p) noexcept;

} // namespace echinus
