#pragma once

#include "directions/lattice.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/mesh.hpp>

namespace echinus {

/// Snaps the mesh to the lattice of a centre around which coarse maps of the wanted kind are wrong at few
/// places beside the surface. Builds 19 of them.
/// @throws Error as LatticeSnapper::snap()
LatticeMesh snap_around_best_centre(const TriangleMesh& mesh, const DistanceMapOptions& options);

} // namespace echinus
