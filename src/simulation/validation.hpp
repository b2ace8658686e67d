#pragma once

#include <echinus/simulation.hpp>

namespace echinus {

// Each throws Error InvalidOptions with a sentence that names the field or the index at fault.

void require_valid(const SimulationOptions& options);
void require_valid(const Deformable& deformable);
void require_valid(const std::vector<Collider>& colliders);

} // namespace echinus
