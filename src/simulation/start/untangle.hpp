#pragma once

#include "simulation/start/inner_layer.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// Moves the particles of a deformable that intersects models or itself at the start, or is inside models,
/// until nothing intersects or there is no more progress; require_apart() then names the remaining
/// intersections. Pinned particles stay. Velocities do not change; if nothing intersects, neither do
/// positions.
/// @pre deformable, colliders and options are valid, surfaces collide, and the thickness is set
/// @param inner_layers  what is behind them counts as inside; empty for the innermost of several layers.
/// Nothing if no order is known: then whole surfaces may leave a model to their front or back
/// @param progress  receives the share of the initial intersections that are gone; or empty
/// @return whether nothing intersects
bool untangle(Deformable& deformable, const std::vector<Collider>& colliders,
              const SimulationOptions& options, std::optional<std::span<const InnerLayer>> inner_layers = {},
              const std::function<void(double share)>& progress = {});

} // namespace echinus
