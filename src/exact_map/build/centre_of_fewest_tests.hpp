#pragma once

#include "directions/lattice.hpp"
#include "exact_map/build/bands.hpp"

#include <echinus/mesh.hpp>

#include <span>

namespace echinus {

/// Snaps the mesh to the lattice of a centre from which queries should test few faces, estimated by maps of
/// few cells. About twenty coarse builds.
/// @throws Error as LatticeSnapper::snap()
void snap_around_best_centre(LatticeSnapper& snapper, std::span<const Vec3f> vertices, unsigned thread_count,
                             BandFinder& finder, LatticeMesh& best);

} // namespace echinus
