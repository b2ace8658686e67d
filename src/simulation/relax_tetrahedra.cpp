// The relaxation of tetrahedra: a plain loop, and a kernel that takes as many tetrahedra of a run at once as
// the instruction set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/relax_tetrahedra.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simulation/tetrahedra-inl.hpp"
#include "simulation/tetrahedra.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// Where the substep began only turns the corrections: rounded is enough.
template <typename Kind>
HWY_INLINE void relax_at(std::size_t i, TetrahedronArrays& all, Particles& particles) {
    const CompensatedPlaces places{particles.positions, particles.remainders};
    Tetrahedra<Kind> now(all, i, places, RoundedPlaces{particles.previous});
    auto shape = Kind::load(all.shape_multipliers, i), volume = Kind::load(all.volume_multipliers, i);
    now.relax_shape(Kind::load(all.shape_stiffnesses, i), shape);
    now.relax_volume(Kind::load(all.volume_stiffnesses, i), volume);
    now.store(places);
    if (!all.keeps_multipliers) return;
    Kind::store(shape, all.shape_multipliers, i);
    Kind::store(volume, all.volume_multipliers, i);
}

template <typename Kind>
HWY_INLINE void damp_at(std::size_t i, const TetrahedronArrays& all, Particles& particles) {
    const CompensatedPlaces places{particles.positions, particles.remainders};
    Tetrahedra<Kind> now(all, i, places,
                         CompensatedPlaces{particles.previous, particles.previous_remainders});
    now.damp(Kind::load(all.viscosities, i));
    now.store(places);
}

/// As many of the run as fill whole vectors. @return how many
std::size_t relax_tetrahedron_run(const ConstraintRun& run, TetrahedronArrays& all, Particles& particles) {
    const std::size_t lanes = hn::Lanes(kFloat);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes) relax_at<InLanes>(run.first + i, all, particles);
    return i;
}
std::size_t damp_tetrahedron_run(const ConstraintRun& run, const TetrahedronArrays& all,
                                 Particles& particles) {
    const std::size_t lanes = hn::Lanes(kFloat);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes) damp_at<InLanes>(run.first + i, all, particles);
    return i;
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(relax_tetrahedron_run);
HWY_EXPORT(damp_tetrahedron_run);

} // namespace

void damp(const TetrahedronArrays& all, Particles& particles, const Workers& workers) noexcept {
    if (!all.is_viscous) return;
    all.schedule.for_each_run(workers, [&](const ConstraintRun& run) {
        const std::size_t done =
            use_kernels() ? ECHINUS_DISPATCH(damp_tetrahedron_run)(run, all, particles) : 0;
        for (std::size_t i = done; i < run.count; ++i)
            HWY_NAMESPACE::damp_at<HWY_NAMESPACE::OneByOne>(run.first + i, all, particles);
    });
}

void relax(TetrahedronArrays& all, Particles& particles, const Workers& workers) noexcept {
    all.schedule.for_each_run(workers, [&](const ConstraintRun& run) {
        const std::size_t done =
            use_kernels() ? ECHINUS_DISPATCH(relax_tetrahedron_run)(run, all, particles) : 0;
        for (std::size_t i = done; i < run.count; ++i)
            HWY_NAMESPACE::relax_at<HWY_NAMESPACE::OneByOne>(run.first + i, all, particles);
    });
}

} // namespace echinus
#endif // HWY_ONCE
