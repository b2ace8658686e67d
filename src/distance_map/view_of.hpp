#pragma once

#include "directions/lattice.hpp"

#include <echinus/distance_map.hpp>

namespace echinus {

/// The part of a view that the options and the mesh around its centre decide, before any ray is cast.
DistanceMapView view_of(const DistanceMapOptions& options, const LatticeMesh& lattice);

} // namespace echinus
