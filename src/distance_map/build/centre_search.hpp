#pragma once

#include "directions/lattice.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/mesh.hpp>

namespace echinus {

/// Snaps the mesh to the lattice of a centre around which coarse maps of the kind that is wanted are wrong
/// about few places beside the surface. Nineteen of them are built.
/// @throws Error as LatticeSnapper::snap()
LatticeMesh snap_around_best_centre(const TriangleMesh& mesh, const DistanceMapOptions& options);

} // namespace echinus
