#pragma once

#include "simulation/constraint_particles.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace echinus {

/// The order in which constraints are relaxed, for lanes and for threads.
///
/// They stand slab by slab, along the particles' numbers: first every second slab, then those between, then
/// what reaches farther. Slabs of one kind have no particle in common: a thread relaxes one while another
/// relaxes the next, in memory that only it writes. Within a slab, constraints without a common particle
/// stand side by side, so that one instruction relaxes many.
///
/// Neighbours have to have near numbers, as they do in meshes that were made row by row and in those of
/// tetrahedralize(). Where they do not, a slab is as good as everything.
/// @param per_slab  constraints at least, as many as are worth handing to another thread
/// @return the constraints' numbers
std::vector<std::uint32_t> relaxation_order(const ConstraintParticles& constraints, std::size_t per_slab);

/// Puts them into this order. @param particles_of  gives a constraint's particles as an array
template <typename Constraint, typename ParticlesOf>
void order_for_relaxation(std::vector<Constraint>& constraints, std::size_t particle_count,
                          std::size_t per_slab, const ParticlesOf& particles_of) {
    const ConstraintParticles particles(constraints.size(), particle_count,
                                        [&](std::size_t i) { return particles_of(constraints[i]); });
    std::vector<Constraint> ordered;
    ordered.reserve(constraints.size());
    for (const std::uint32_t i : relaxation_order(particles, per_slab)) ordered.push_back(constraints[i]);
    constraints = std::move(ordered);
}

} // namespace echinus
