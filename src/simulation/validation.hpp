#pragma once

#include <echinus/simulation.hpp>

#include <string>
#include <vector>

namespace echinus {

// Each throws Error InvalidOptions with a sentence that names the field or the index at fault.

void require_valid(const SimulationOptions& options);
void require_valid(const Deformable& deformable);
void require_valid(const std::vector<Collider>& colliders, const SimulationOptions& options);
/// @param owner  of the pose, as the sentence begins: "collider 0"
void require_valid(const RigidTransform& pose, const std::string& owner);

} // namespace echinus
