#pragma once

#include "directions/lattice.hpp"
#include "exact_map/bands.hpp"

#include <echinus/mesh.hpp>

namespace echinus {

/// The mesh on the lattice of a centre from which a query is expected to test few faces: a pattern search
/// from the bounding sphere's centre (Hooke and Jeeves 1961), on maps of few cells. Some twenty coarse
/// builds.
/// @throws Error as snap_to_lattice()
LatticeMesh snap_around_best_centre(const TriangleMesh& mesh, unsigned thread_count, BandFinder& finder);

} // namespace echinus
