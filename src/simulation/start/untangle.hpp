#pragma once

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// Moves the particles of a deformable that at the start intersects models or, with self_collision, itself,
/// or is inside models, until nothing intersects or no way is found; require_apart() then names what is left.
/// Pinned particles stay. Velocities do not change; if nothing intersects, neither do positions.
/// @pre deformable, colliders and options are valid, with surface_collision and a thickness
void untangle(Deformable& deformable, const std::vector<Collider>& colliders,
              const SimulationOptions& options);

} // namespace echinus
