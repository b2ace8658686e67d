// The relaxation of folds: the plain loop, which is the specification, and a kernel that takes as many folds
// of a run at once as the instruction set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/relax_folds.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "directions/angles-inl.hpp"
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/folds.hpp"
#include "simulation/places-inl.hpp"

#include <algorithm>
#include <limits>

#ifndef ECHINUS_SIMULATION_RELAX_FOLDS_RULES
#define ECHINUS_SIMULATION_RELAX_FOLDS_RULES
namespace echinus {
namespace {

/// No relaxation turns a fold by more than this, in radians: its particles move along straight lines, which
/// stretches the faces of a sharp fold.
constexpr float kLargestTurn = 1;

/// Outside of these limits of the turn per step a face has no area, or next to none.
constexpr float kLeastRate = std::numeric_limits<float>::min();
constexpr float kMostRate = std::numeric_limits<float>::max();

/// An end of the edge whose other three particles are pinned on one line has no gradient: what both faces
/// give it cancels, or the feet of both corners lie at the other end. Rounding is all that is left then, and
/// a step divided by its square goes anywhere. So the turn per step counts as no less than this share of what
/// it would be if each end turned both faces as the corners do. It is more than a sixth of a fold of four
/// free particles of one mass.
constexpr float kLeastRateShare = 1.0F / 64;

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// relax_one() of the folds from i on.
template <typename Places>
HWY_INLINE void relax_lanes(FoldArrays& folds, std::size_t i, const Places& places) {
    const FloatLanes one = splat(1), zero = splat(0);
    const GatheredParticles at_a{load_indices(&folds.a[i])}, at_b{load_indices(&folds.b[i])},
        at_c{load_indices(&folds.c[i])}, at_d{load_indices(&folds.d[i])};
    const auto a = places.load(at_a), b = places.load(at_b), c = places.load(at_c), d = places.load(at_d);
    const FloatLanes mass_a = hn::LoadU(kFloat, &folds.inverse_mass_a[i]),
                     mass_b = hn::LoadU(kFloat, &folds.inverse_mass_b[i]),
                     mass_c = hn::LoadU(kFloat, &folds.inverse_mass_c[i]),
                     mass_d = hn::LoadU(kFloat, &folds.inverse_mass_d[i]);
    const PointLanes edge = b.from(a), to_c = c.from(a), to_d = d.from(a);
    const PointLanes area_c = cross(edge, to_c), area_d = cross(to_d, edge);
    const FloatLanes edge_length = length(edge);
    const FloatLanes size_c = length(area_c), size_d = length(area_d);
    const PointLanes normal_c = area_c * (one / size_c), normal_d = area_d * (one / size_d);
    const FloatLanes rate_c = edge_length / size_c, rate_d = edge_length / size_d;

    const FloatLanes per_length_sq = one / dot(edge, edge);
    const FloatLanes foot_c = dot(to_c, edge) * per_length_sq, foot_d = dot(to_d, edge) * per_length_sq;
    const PointLanes gradient_c = normal_c * rate_c, gradient_d = normal_d * rate_d;
    const PointLanes gradient_a = -(gradient_c * (one - foot_c) + gradient_d * (one - foot_d));
    const PointLanes gradient_b = -(gradient_c * foot_c + gradient_d * foot_d);

    const FloatLanes rate = dot(gradient_a, gradient_a) * mass_a + dot(gradient_b, gradient_b) * mass_b +
                            dot(gradient_c, gradient_c) * mass_c + dot(gradient_d, gradient_d) * mass_d;
    const FloatMask has_angle = hn::And(rate >= splat(kLeastRate), rate <= splat(kMostRate));
    const FloatLanes rate_of_ends = rate_c + rate_d;
    const FloatLanes largest_rate =
        rate_of_ends * rate_of_ends * (mass_a + mass_b) + rate_c * rate_c * mass_c + rate_d * rate_d * mass_d;
    const FloatLanes least_rate = largest_rate * splat(kLeastRateShare);
    const FloatLanes sound_rate = choose(rate < least_rate, least_rate, rate);
    const FloatLanes goal = hn::LoadU(kFloat, &folds.goal_angles[i]);
    const FloatLanes compliance = hn::LoadU(kFloat, &folds.compliances[i]);
    const FloatLanes angle = angle_of(dot(normal_c, to_d) * rate_d, dot(normal_c, normal_d));
    const FloatLanes wanted = (goal - angle) * splat(folds.stiffness) / (sound_rate + compliance);
    const FloatLanes most = splat(kLargestTurn) / sound_rate, least = zero - most;
    const FloatLanes bounded = choose(wanted < least, least, choose(most < wanted, most, wanted));
    const auto put = [&](const auto& before, const PointLanes& gradient, const FloatLanes& mass,
                         const GatheredParticles& at) HWY_ATTR {
        auto moved = before;
        moved.move(gradient * (bounded * mass));
        places.store(choose(has_angle, moved, before), at);
    };
    put(a, gradient_a, mass_a, at_a);
    put(b, gradient_b, mass_b, at_b);
    put(c, gradient_c, mass_c, at_c);
    put(d, gradient_d, mass_d, at_d);
    hn::StoreU(choose(has_angle, goal - bounded * compliance, goal), kFloat, &folds.goal_angles[i]);
}

template <typename Places>
std::size_t relax_whole_vectors(const ConstraintRun& run, FoldArrays& folds, const Places& places) {
    const std::size_t lanes = hn::Lanes(kFloat);
    std::size_t i = 0;
    for (; i + lanes <= run.count; i += lanes) relax_lanes(folds, run.first + i, places);
    return i;
}

/// Relaxes as many folds of the run as fill whole vectors. @return how many
std::size_t relax_fold_run(const ConstraintRun& run, FoldArrays& folds, PointArrays& positions,
                           PointArrays* remainders) {
    return remainders != nullptr ? relax_whole_vectors(run, folds, CompensatedPlaces{positions, *remainders})
                                 : relax_whole_vectors(run, folds, RoundedPlaces{positions});
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(relax_fold_run);

/// A fold as its particles lie now.
struct FoldNow {
    Vec3f edge, to_c, to_d; ///< from a
    Vec3f normal_c, normal_d;
    float rate_c, rate_d; ///< 1 / height over the edge

    FoldNow(const Vec3f& edge_in, const Vec3f& to_c_in, const Vec3f& to_d_in)
        : edge(edge_in), to_c(to_c_in), to_d(to_d_in) {
        const Vec3f area_c = cross(edge, to_c), area_d = cross(to_d, edge);
        const float edge_length = length(edge);
        const float size_c = length(area_c), size_d = length(area_d);
        normal_c = area_c * (1 / size_c);
        normal_d = area_d * (1 / size_d);
        rate_c = edge_length / size_c;
        rate_d = edge_length / size_d;
    }
    float angle() const { return atan2_polynomial(dot(normal_c, to_d) * rate_d, dot(normal_c, normal_d)); }
};

template <typename Places>
void relax_one(FoldArrays& folds, std::size_t i, const Places& places) {
    using HWY_NAMESPACE::OneParticle;
    const OneParticle at_a{folds.a[i]}, at_b{folds.b[i]}, at_c{folds.c[i]}, at_d{folds.d[i]};
    auto a = places.load(at_a), b = places.load(at_b), c = places.load(at_c), d = places.load(at_d);
    const float mass_a = folds.inverse_mass_a[i], mass_b = folds.inverse_mass_b[i],
                mass_c = folds.inverse_mass_c[i], mass_d = folds.inverse_mass_d[i];
    const FoldNow fold(b.from(a), c.from(a), d.from(a));
    const float per_length_sq = 1 / dot(fold.edge, fold.edge);
    const float foot_c = dot(fold.to_c, fold.edge) * per_length_sq;
    const float foot_d = dot(fold.to_d, fold.edge) * per_length_sq;
    const Vec3f gradient_c = fold.normal_c * fold.rate_c, gradient_d = fold.normal_d * fold.rate_d;
    const Vec3f gradient_a = -(gradient_c * (1 - foot_c) + gradient_d * (1 - foot_d));
    const Vec3f gradient_b = -(gradient_c * foot_c + gradient_d * foot_d);

    // By how much a step along the gradient turns the fold. NaN where an edge has no length.
    const float rate = dot(gradient_a, gradient_a) * mass_a + dot(gradient_b, gradient_b) * mass_b +
                       dot(gradient_c, gradient_c) * mass_c + dot(gradient_d, gradient_d) * mass_d;
    if (!(rate >= kLeastRate && rate <= kMostRate)) return;
    const float rate_of_ends = fold.rate_c + fold.rate_d;
    const float largest_rate = rate_of_ends * rate_of_ends * (mass_a + mass_b) +
                               fold.rate_c * fold.rate_c * mass_c + fold.rate_d * fold.rate_d * mass_d;
    const float least_rate = largest_rate * kLeastRateShare;
    const float sound_rate = rate < least_rate ? least_rate : rate;
    float& goal = folds.goal_angles[i];
    const float wanted = (goal - fold.angle()) * folds.stiffness / (sound_rate + folds.compliances[i]);
    const float most = kLargestTurn / sound_rate;
    const float step = std::clamp(wanted, -most, most);
    const auto put = [&](auto& place, const Vec3f& gradient, float mass, const OneParticle& at) {
        place.move(gradient * (step * mass));
        places.store(place, at);
    };
    put(a, gradient_a, mass_a, at_a);
    put(b, gradient_b, mass_b, at_b);
    put(c, gradient_c, mass_c, at_c);
    put(d, gradient_d, mass_d, at_d);
    goal = goal - step * folds.compliances[i];
}

void relax_run(const ConstraintRun& run, FoldArrays& folds, PointArrays& positions, PointArrays* remainders) {
    const std::size_t done =
        use_kernels() ? ECHINUS_DISPATCH(relax_fold_run)(run, folds, positions, remainders) : 0;
    for (std::size_t i = run.first + done; i < run.first + run.count; ++i)
        if (remainders != nullptr)
            relax_one(folds, i, HWY_NAMESPACE::CompensatedPlaces{positions, *remainders});
        else
            relax_one(folds, i, HWY_NAMESPACE::RoundedPlaces{positions});
}

} // namespace

float fold_angle(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
    const FoldNow fold(b - a, c - a, d - a);
    const bool has_angle = fold.rate_c <= kMostRate && fold.rate_d <= kMostRate;
    return has_angle ? fold.angle() : 0;
}

void relax(FoldArrays& folds, PointArrays& positions, PointArrays* remainders,
           const Workers& workers) noexcept {
    folds.schedule.for_each_run(
        workers, [&](const ConstraintRun& run) { relax_run(run, folds, positions, remainders); });
}

} // namespace echinus
#endif // HWY_ONCE
