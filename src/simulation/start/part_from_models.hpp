#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// Moves the surface of a deformable out of models where it intersects them or lies inside: particles inside
/// out to the thickness, and then, step by step, elements that still intersect.
///
/// Three ways are tried. *Nearest*: each particle goes along the normal of the surface point that is nearest
/// to it. *Forwards* and *backwards*: all particles of a connected part go along the mean normal of its
/// faces, or against it. The nearest way suits a sleeve that cuts a little into an arm. It fails where
/// particles on the two sides of a model's middle go apart, and where a tip pierces a face; with one
/// direction for all, a plane sheet becomes a relief there. Of the ways that leave nothing intersecting, the
/// one that stretches edges least is taken.
///
/// @param positions  [particle_count] of the particles; pinned ones stay where they are
/// @return whether a particle was moved
/// @pre the options have a thickness, and every collider an exact map
bool part_from_models(const Elements& elements, const Deformable& deformable,
                      const std::vector<Collider>& colliders, const SimulationOptions& options,
                      std::vector<Vec3f>& positions);

} // namespace echinus
