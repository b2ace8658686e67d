#pragma once

#include "directions/lattice.hpp"

#include <echinus/geometry.hpp>

#include <functional>
#include <span>

namespace echinus {

/// Snaps a mesh to the lattice of a low-cost centre. Pattern search from the bounding sphere's centre, with
/// steps of a quarter to a sixteenth of the radius (Hooke and Jeeves, "Direct Search Solution of Numerical
/// and Statistical Problems", 1961). Evaluates 19 costs.
/// @param cost_of  a pure function of the lattice
/// @param best     becomes the lattice mesh
/// @throws Error as LatticeSnapper::snap()
void snap_at_lowest_cost(LatticeSnapper& snapper, std::span<const Vec3f> vertices,
                         const std::function<double(const LatticeMesh&)>& cost_of, LatticeMesh& best);

} // namespace echinus
