#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map.hpp>

#include <vector>

/// The border of an open surface; exact_map/border_part.hpp says what it is needed for.
namespace echinus {

/// The edges along which a different number of faces runs one way than the other, ascending. Vertices on one
/// lattice point count as one. Empty when the surface is closed, as it surely is where mesh/is_closed.hpp
/// finds it so: that takes less time, and what collapses on the lattice has no border there.
std::vector<BorderEdge> find_border(const LatticeMesh& lattice);

} // namespace echinus
