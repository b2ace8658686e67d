#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map.hpp>

#include <vector>

/// The border of an open surface; exact_map/border_part.hpp explains its use.
namespace echinus {

/// The edges along which different numbers of faces run in the two directions, ascending. Vertices on one
/// lattice point count as one. Empty when the surface is closed, as it surely is where mesh/is_closed.hpp
/// finds it so: that takes less time, and what collapses on the lattice has no border there.
std::vector<BorderEdge> find_border(const LatticeMesh& lattice);

} // namespace echinus
