#pragma once

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace echinus {

/// Contact of surfaces keeps apart what is apart, so it has to begin so: no face or thread of the deformable
/// may intersect a model, no particle may lie inside one, and with self_collision no two faces may intersect
/// beyond what they share. Decided exactly, in the frame of each model. With self_collision floats have to
/// tell its layers apart where it begins.
/// @pre deformable, colliders and options are valid, with surface_collision
/// @throws Error InvalidOptions, naming the first pairs, or the first particle inside
void require_apart(const Deformable& deformable, const std::vector<Collider>& colliders,
                   const SimulationOptions& options);

/// The same of one model where a deformable is set elsewhere.
/// @param places  [particle_count] where it is to be
/// @param passes  as let_through() has it
/// @param name    of the model
/// @throws Error InvalidOptions
void require_no_meeting(const Deformable& deformable, std::span<const Vec3f> places,
                        std::span<const std::uint8_t> passes, const Collider& collider,
                        const std::string& name);

} // namespace echinus
