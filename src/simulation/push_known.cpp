// Particles against what is known of the surface around them: the plain functions, which are the
// specification, and kernels that take as many particles at once as the instruction set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/push_known.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/compress-inl.hpp"
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/contact_response.hpp"
#include "simulation/known_contacts.hpp"
#include "simulation/places-inl.hpp"

#include <cmath>

#ifndef ECHINUS_SIMULATION_PUSH_KNOWN_RULES
#define ECHINUS_SIMULATION_PUSH_KNOWN_RULES
namespace echinus {
namespace {

/// Relative to lengths and coordinates: the error of a distance between two places in the world, since both
/// were rounded to single precision in two frames, as was their distance: less than 12 x 2^-24.
constexpr float kRounding = 1.0F / (1 << 20);

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

HWY_INLINE FloatLanes load(const float* from) {
    return hn::LoadU(kFloat, from);
}
HWY_INLINE PointLanes load(const PointArrays& points, std::size_t i) {
    return {load(&points.x[i]), load(&points.y[i]), load(&points.z[i])};
}

/// The particles i, i + 1 ..., of which only some are stored.
struct ChosenParticles {
    using Point = PointLanes;
    std::size_t i;
    FloatMask chosen;

    HWY_INLINE PointLanes load(const PointArrays& from) const { return HWY_NAMESPACE::load(from, i); }
    HWY_INLINE void store(const PointLanes& points, PointArrays& to) const {
        hn::BlendedStore(points.x, chosen, kFloat, &to.x[i]);
        hn::BlendedStore(points.y, chosen, kFloat, &to.y[i]);
        hn::BlendedStore(points.z, chosen, kFloat, &to.z[i]);
    }
};

/// Adds the chosen ones of the particles i, i + 1 ... to a list.
HWY_INLINE void add(const FloatMask& chosen, std::size_t i, ParticleList& list) {
    const Compressor compress(hn::RebindMask(Ints(), chosen));
    const IntLanes particles = hn::Iota(Ints(), static_cast<std::int32_t>(i));
    hn::StoreU(hn::BitCast(hn::RebindToUnsigned<Ints>(), compress(particles)), hn::RebindToUnsigned<Ints>(),
               &list.particles[list.count]);
    list.count += compress.count();
}

/// MaterialMotion::at().
HWY_INLINE PointLanes motion_at(const MaterialMotion& material, const PointLanes& place) {
    const PointLanes from_centre = place - splat(material.centre);
    const PointLanes turned{dot(splat(material.turn_x), from_centre),
                            dot(splat(material.turn_y), from_centre),
                            dot(splat(material.turn_z), from_centre)};
    return turned + splat(material.shift);
}

/// push_out(), and what comes of it.
template <typename Places>
HWY_INLINE void push(const ChosenParticles& below, const FloatLanes& missing, const PointLanes& normal,
                     const ColliderNow& collider, const Places& now, const Places& before) {
    const FloatLanes zero = splat(0);
    const auto place = now.load(below);
    auto previous = before.load(below);
    PointLanes surface_motion = motion_at(collider.material, place.position);
    if (collider.drift != nullptr) surface_motion = surface_motion + load(*collider.drift, below.i);
    const PointLanes motion = place.from(previous) - surface_motion;
    const FloatLanes toward = zero - dot(motion, normal);
    const FloatLanes approach = hn::IfThenElse(zero < toward, toward, zero);
    const FloatLanes back = hn::IfThenElse(approach < missing, approach, missing);
    const PointLanes pushed = motion + normal * missing;
    const PointLanes tangential = pushed - normal * dot(pushed, normal);
    const FloatLanes slip = length(tangential);
    const FloatLanes grip = splat(collider.friction) * back;
    const FloatLanes share = hn::IfThenElse(slip <= grip, splat(1), grip / slip);
    auto next = previous;
    next.move(surface_motion + (pushed - tangential * share));
    now.store(next, below);
    previous.move(normal * (missing - back));
    before.store(previous, below);
}

template <typename Places>
std::size_t push_lanes(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                       std::size_t end, const Places& now, const Places& before, ParticleList& to_ask) {
    const FloatLanes thickness = splat(collider.thickness);
    const FloatLanes reuse = splat(kPlaneReuse * collider.thickness);
    std::size_t pushed_count = 0;
    for (std::size_t i = first; i < end; i += hn::Lanes(Floats())) {
        const auto place = now.load(ChosenParticles{i, {}});
        const PointLanes asked_at = load(known.asked_at, i);
        const PointLanes moved = place.position - asked_at;
        const FloatLanes moved_sq = dot(moved, moved);
        const FloatLanes quiet = load(&known.clearance[i]) - thickness;
        const FloatMask far = moved_sq < quiet * hn::Abs(quiet);
        if (hn::AllTrue(Floats(), far)) continue;
        const FloatLanes height = load(&known.height[i]);
        const FloatMask usable = hn::And(moved_sq <= reuse * reuse, height < splat(KnownContacts::kNoPlane));
        const FloatMask unknown = hn::Not(hn::Or(far, usable));
        if (!hn::AllFalse(Floats(), unknown)) add(unknown, i, to_ask);
        const PointLanes normal = load(known.normal, i);
        const FloatLanes missing = thickness - (height + dot(place.from(asked_at), normal));
        const FloatMask below = hn::And(hn::AndNot(far, usable), missing > splat(0));
        if (hn::AllFalse(Floats(), below)) continue;
        push(ChosenParticles{i, below}, missing, normal, collider, now, before);
        pushed_count += hn::CountTrue(Floats(), below);
    }
    return pushed_count;
}

std::size_t push_known_lanes(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                             std::size_t end, Particles& particles, ParticleList& to_ask) {
    if (particles.keeps_remainders)
        return push_lanes(known, collider, first, end,
                          CompensatedPlaces{particles.positions, particles.remainders},
                          CompensatedPlaces{particles.previous, particles.previous_remainders}, to_ask);
    return push_lanes(known, collider, first, end, RoundedPlaces{particles.positions},
                      RoundedPlaces{particles.previous}, to_ask);
}

void list_unproven_lanes(const KnownContacts& known, const ColliderNow& collider,
                         const PointArrays& positions, const PointArrays& free_places,
                         std::size_t particle_count, ParticleList& unproven) {
    for (std::size_t i = 0; i < particle_count; i += hn::Lanes(Floats())) {
        const PointLanes position = load(positions, i), asked_at = load(known.asked_at, i);
        const PointLanes moved = position - asked_at;
        const PointLanes free_moved = load(free_places, i) - asked_at;
        const FloatLanes clearance = load(&known.clearance[i]);
        const FloatLanes size = l1_norm(position) + splat(collider.coordinate_sum) + clearance;
        const FloatLanes radius = clearance - splat(collider.guard) - size * splat(kRounding);
        const FloatLanes radius_sq = radius * hn::Abs(radius);
        const FloatMask in_ball =
            hn::And(dot(moved, moved) < radius_sq, dot(free_moved, free_moved) < radius_sq);
        if (!hn::AllTrue(Floats(), in_ball)) add(hn::Not(in_ball), i, unproven);
    }
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(push_known_lanes);
HWY_EXPORT(list_unproven_lanes);

std::size_t push_one_by_one(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                            std::size_t end, Particles& particles, ParticleList& to_ask) {
    const float reuse = kPlaneReuse * collider.thickness;
    std::size_t pushed_count = 0;
    for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
        const Vec3f moved = particles.positions[i] - known.asked_at[i];
        const float moved_sq = dot(moved, moved);
        const float quiet = known.clearance[i] - collider.thickness;
        if (moved_sq < quiet * std::fabs(quiet)) continue;
        const bool usable = moved_sq <= reuse * reuse && known.height[i] < KnownContacts::kNoPlane;
        if (!usable)
            to_ask.add(i);
        else
            pushed_count += push_one(known, collider, i, particles) ? 1 : 0;
    }
    return pushed_count;
}

} // namespace

bool push_one(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
              Particles& particles) noexcept {
    const Vec3f position = particles.positions[i];
    const Vec3f normal = known.normal[i];
    const Vec3f moved = (position - known.asked_at[i]) + particles.remainders[i];
    const float missing = collider.thickness - (known.height[i] + dot(moved, normal));
    if (!(missing > 0)) return false;
    const Vec3f surface_motion = collider.motion_at(i, position);
    const auto [motion, excess] =
        push_out(particles.step(i) - surface_motion, normal, missing, collider.friction);
    particles.set_step(i, surface_motion + motion);
    particles.move_previous(i, normal * excess);
    return true;
}

std::size_t push_known(const KnownContacts& known, const ColliderNow& collider, std::size_t first,
                       std::size_t end, Particles& particles, ParticleList& to_ask) noexcept {
    if (!use_kernels()) return push_one_by_one(known, collider, first, end, particles, to_ask);
    return ECHINUS_DISPATCH(push_known_lanes)(known, collider, first, end, particles, to_ask);
}

bool is_known_free(const KnownContacts& known, const ColliderNow& collider, std::size_t i,
                   const Vec3f& position, const Vec3f& free_place) noexcept {
    const Vec3f moved = position - known.asked_at[i];
    const Vec3f free_moved = free_place - known.asked_at[i];
    const float clearance = known.clearance[i];
    const float size = std::fabs(position.x) + std::fabs(position.y) + std::fabs(position.z) +
                       collider.coordinate_sum + clearance;
    const float radius = clearance - collider.guard - size * kRounding;
    const float radius_sq = radius * std::fabs(radius);
    return dot(moved, moved) < radius_sq && dot(free_moved, free_moved) < radius_sq;
}

void list_unproven(const KnownContacts& known, const ColliderNow& collider, const PointArrays& positions,
                   const PointArrays& free_places, ParticleList& unproven) noexcept {
    const std::size_t particle_count = known.clearance.size() - PointArrays::kPadding;
    if (use_kernels()) {
        ECHINUS_DISPATCH(list_unproven_lanes)
        (known, collider, positions, free_places, particle_count, unproven);
        return;
    }
    for (std::uint32_t i = 0; i < particle_count; ++i)
        if (!is_known_free(known, collider, i, positions[i], free_places[i])) unproven.add(i);
}

} // namespace echinus
#endif // HWY_ONCE
