#include "simulation/folds.hpp"

namespace echinus {

FoldArrays weighted_folds(const Deformable& deformable, const SimulationOptions& options) {
    constexpr auto kKind = static_cast<std::size_t>(StickKind::Bending);
    const bool springs = options.solver == SolverKind::Xpbd;
    const double substep = options.time_step / options.substep_count;
    FoldArrays folds;
    folds.stiffness = springs ? 1.0F : static_cast<float>(options.stiffness[kKind]);
    for (const Fold& fold : deformable.folds) {
        const float mass_a = deformable.inverse_masses[fold.a], mass_b = deformable.inverse_masses[fold.b],
                    mass_c = deformable.inverse_masses[fold.c], mass_d = deformable.inverse_masses[fold.d];
        if (mass_a + mass_b + mass_c + mass_d == 0) continue; // all pinned
        folds.a.push_back(fold.a);
        folds.b.push_back(fold.b);
        folds.c.push_back(fold.c);
        folds.d.push_back(fold.d);
        folds.inverse_mass_a.push_back(mass_a);
        folds.inverse_mass_b.push_back(mass_b);
        folds.inverse_mass_c.push_back(mass_c);
        folds.inverse_mass_d.push_back(mass_d);
        folds.rest_angles.push_back(fold.rest_angle);
        const double lever = fold.lever * substep;
        folds.compliances.push_back(springs ? static_cast<float>(options.compliance[kKind] / (lever * lever))
                                            : 0.0F);
    }
    const ConstraintParticles particles(folds.count(), deformable.particle_count(), [&](std::size_t i) {
        return std::array{folds.a[i], folds.b[i], folds.c[i], folds.d[i]};
    });
    folds.schedule = schedule_of(particles, kFoldsPerSlab);
    folds.goal_angles = folds.rest_angles;
    return folds;
}

} // namespace echinus
