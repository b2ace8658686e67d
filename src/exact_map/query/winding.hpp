#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

#include <cstdint>

namespace echinus {

/// How often the surface winds around a place.
struct Winding {
    std::int64_t number = 0; ///< of an open surface the generalised winding number, rounded
    bool certain = true;     ///< false where an open surface's had to be computed
};

/// The winding number around a particle. This scalar code is the specification of inside and outside.
Winding winding_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) noexcept;

/// The same for a place of the lattice, or a few steps beyond it
Winding winding_at(const ExactMapView& map, const LatticePoint& p) noexcept;

} // namespace echinus
