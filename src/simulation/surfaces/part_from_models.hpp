#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// Moves the surface of a deformable out of models where it intersects them or lies inside: particles inside
/// out to the thickness, and then, step by step, elements that still intersect.
///
/// Three ways are tried. *By the nearest way*: each particle along the normal of the surface point that is
/// nearest to it. *Forwards* and *backwards*: all particles of a connected part along the mean normal of its
/// faces, or against it. The nearest way suits a sleeve that cuts a little into an arm. It fails where
/// particles on both sides of a model's middle part from each other, and where a tip pierces a face, which
/// one direction for all masters: a plane sheet becomes a relief. Of the ways that leave nothing intersecting
/// the one is taken that stretches edges least.
///
/// @param positions  [particle_count] of the particles; those without a deformable's mass stay where they are
/// @return whether a particle was moved
/// @pre the options have a thickness, and every collider an exact map
bool part_from_models(const Elements& elements, const std::vector<float>& inverse_masses,
                      const std::vector<Collider>& colliders, const SimulationOptions& options,
                      std::vector<Vec3f>& positions);

} // namespace echinus
