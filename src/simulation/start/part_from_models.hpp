#pragma once

#include "simulation/surfaces/elements.hpp"

#include <echinus/collider.hpp>
#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// Moves the surface of a deformable out of models if it intersects them or is inside: first particles
/// inside, out to the thickness, and then, step by step, elements that still intersect.
///
/// Three methods are tried. *Nearest*: each particle moves along the normal of the surface point nearest to
/// it. *Forwards* and *backwards*: all particles of a connected part move along the mean normal of its faces,
/// or against it. The first method suits a sleeve that cuts a little into an arm. It fails if particles on
/// the two sides of a model's middle move apart, or if a tip pierces a face; with one direction for all
/// particles, a plane sheet there becomes a relief. Of the results with the fewest intersections, the one
/// that stretches edges least is chosen.
///
/// @param positions  [particle_count] of the particles; pinned ones stay where they are
/// @return whether a particle was moved
/// @pre the options have a thickness, and every collider an exact map
bool part_from_models(const Elements& elements, const Deformable& deformable,
                      const std::vector<Collider>& colliders, const SimulationOptions& options,
                      std::vector<Vec3f>& positions);

} // namespace echinus
