#pragma once

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// Contact of surfaces keeps apart only what is apart at the start, so this is required: no face or thread of
/// the deformable may intersect a model, no particle may be inside one, and with self_collision no two faces
/// may intersect except at shared vertices and edges. This is decided exactly, in the frame of each model.
/// With self_collision, floats also have to distinguish its layers at their initial positions.
/// @pre deformable, colliders and options are valid, with surface_collision
/// @throws Error InvalidOptions, naming the first pairs, or the first particle inside
void require_apart(const Deformable& deformable, const std::vector<Collider>& colliders,
                   const SimulationOptions& options);

/// The same for one model when a deformable is moved to other positions.
/// @param places  [particle_count] the new positions
/// @param passes  as returned by let_through()
/// @param name    of the model
/// @throws Error InvalidOptions
void require_no_meeting(const Deformable& deformable, std::span<const Vec3f> places,
                        std::span<const std::uint8_t> passes, const Collider& collider,
                        const std::string& name);

} // namespace echinus
