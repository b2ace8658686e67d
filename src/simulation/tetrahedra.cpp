#include "simulation/tetrahedra.hpp"

#include <algorithm>

namespace echinus {

namespace {

float spread_of(const std::array<Vec3f, 3>& gradients, const std::array<float, 4>& inverse_masses) {
    Vec3d first;
    double spread = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d gradient(gradients[k]);
        first -= gradient;
        spread += dot(gradient, gradient) * double{inverse_masses[k + 1]};
    }
    return static_cast<float>(spread + dot(first, first) * double{inverse_masses[0]});
}

void add(const ElasticTetrahedron& tetrahedron, const std::array<float, 4>& inverse_masses, double substep,
         TetrahedronArrays& all) {
    for (std::size_t k = 0; k < 4; ++k) {
        all.particles[k].push_back(tetrahedron.particles[k]);
        all.inverse_masses[k].push_back(inverse_masses[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        all.gradients[3 * k].push_back(tetrahedron.gradients[k].x);
        all.gradients[3 * k + 1].push_back(tetrahedron.gradients[k].y);
        all.gradients[3 * k + 2].push_back(tetrahedron.gradients[k].z);
    }
    all.spreads.push_back(spread_of(tetrahedron.gradients, inverse_masses));
    const double volume = double{tetrahedron.volume} * substep * substep;
    const double shape = double{tetrahedron.mu} * volume;
    all.shape_stiffnesses.push_back(static_cast<float>(shape));
    all.volume_stiffnesses.push_back(static_cast<float>(double{tetrahedron.lambda} * volume));
    all.viscosities.push_back(static_cast<float>(shape * double{tetrahedron.damping} / substep));
    all.is_viscous = all.is_viscous || tetrahedron.damping > 0;
}

} // namespace

TetrahedronArrays weighted_tetrahedra(const Deformable& deformable, const SimulationOptions& options) {
    const double substep = options.time_step / options.substep_count;
    TetrahedronArrays all;
    for (const ElasticTetrahedron& tetrahedron : deformable.tetrahedra) {
        std::array<float, 4> inverse_masses;
        for (std::size_t k = 0; k < 4; ++k)
            inverse_masses[k] = deformable.inverse_masses[tetrahedron.particles[k]];
        const bool is_held = std::all_of(inverse_masses.begin(), inverse_masses.end(),
                                         [](float inverse_mass) { return inverse_mass == 0; });
        if (!is_held) add(tetrahedron, inverse_masses, substep, all);
    }
    all.keeps_multipliers = options.iteration_count > 1;
    all.shape_multipliers.assign(all.count(), 0);
    all.volume_multipliers.assign(all.count(), 0);
    const ConstraintParticles particles(all.count(), deformable.particle_count(), [&](std::size_t i) {
        return std::array{all.particles[0][i], all.particles[1][i], all.particles[2][i], all.particles[3][i]};
    });
    all.schedule = schedule_of(particles, kTetrahedraPerSlab);
    return all;
}

void TetrahedronArrays::begin_substep() {
    if (!keeps_multipliers) return;
    std::fill(shape_multipliers.begin(), shape_multipliers.end(), 0.0F);
    std::fill(volume_multipliers.begin(), volume_multipliers.end(), 0.0F);
}

} // namespace echinus
