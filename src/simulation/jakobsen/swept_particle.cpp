#include "simulation/jakobsen/swept_particle.hpp"

#include "exact_map/query/stretched_contact.hpp"
#include "simulation/jakobsen/contact_response.hpp"

#include <cmath>

namespace echinus {

SweptParticle::SweptParticle(const ColliderNow& collider, const FreePlaces& free_places, std::size_t i,
                             const Particles& particles)
    : now_(collider), position_(particles.positions[i]), step_(particles.step(i)),
      position_local_(collider.local.point_to_local(position_)), was_free_(free_places.has(i)),
      free_local_(was_free_ ? free_places.local(i, particles) : Vec3f{}) {}

/// Whether a particle that was free is free at this position.
bool SweptParticle::is_free_at(const Vec3f& place_local) const {
    if (sweep(now_.map, free_local_, place_local).found()) return false;
    // For a closed surface, a sweep without a crossing implies this too.
    return now_.map.border.empty() || !contains(now_.map, place_local);
}

bool SweptParticle::is_unproven() const {
    if (!was_free_) return contains(now_.map, position_local_);
    if (!is_free_at(position_local_)) return true;
    return stretched_contact(now_.map, position_local_, now_.guard, now_.scale).found();
}

Vec3f SweptParticle::free_normal(const SweepHit& crossing) const {
    const Vec3f normal = now_.local.scaled_normal(crossing.normal);
    return dot(position_local_ - free_local_, crossing.normal) > 0 ? -normal : normal;
}

std::optional<Placement> SweptParticle::rescued() const {
    if (!was_free_) return rescued_from_inside();
    const SweepHit hit = crossing();
    const std::optional<Placement> found = hit.found() ? rescued_before(hit) : rescued_from_guard();
    return found ? found : taken_back();
}

std::optional<Placement> SweptParticle::rescued_before(const SweepHit& crossing) const {
    return first_free({now_.thickness, now_.thickness / 8, 4 * now_.guard, 2 * now_.guard}, crossing.point,
                      free_normal(crossing));
}

/// Rescues a particle that crossed nothing, but is nearer to the surface than the guard.
std::optional<Placement> SweptParticle::rescued_from_guard() const {
    const Contact nearest = stretched_contact(now_.map, position_local_, now_.guard, now_.scale);
    if (nearest.found())
        if (const auto found = first_free({4 * now_.guard, 2 * now_.guard}, nearest.point, nearest.normal))
            return found;
    // There may not be more room.
    if (is_free_at(position_local_)) return Placement{position_, step_};
    return std::nullopt;
}

/// Rescues a particle that began inside: to the nearest point and beyond.
std::optional<Placement> SweptParticle::rescued_from_inside() const {
    const Contact nearest = stretched_contact(now_.map, position_local_, 0, now_.scale);
    return first_free({now_.thickness, now_.thickness / 8, 4 * now_.guard, 2 * now_.guard}, nearest.point,
                      nearest.normal);
}

std::optional<Placement> SweptParticle::first_free(std::initializer_list<float> gaps,
                                                   const Vec3f& surface_local,
                                                   const Vec3f& normal_body) const {
    for (const float gap : gaps)
        if (const auto found = put(now_.to_body(surface_local) + normal_body * gap, normal_body))
            return found;
    return std::nullopt;
}

/// Puts the particle in a position if it is free there after rounding. The tangential part of its motion
/// remains, reduced by friction.
std::optional<Placement> SweptParticle::put(const Vec3f& target_body, const Vec3f& normal_body) const {
    const Vec3f target = now_.body.point_to_world(target_body);
    const Vec3f target_local = now_.local.point_to_local(target);
    if (was_free_ ? !is_free_at(target_local) : contains(now_.map, target_local)) return std::nullopt;
    const Vec3f normal = now_.body.normal_to_world(normal_body);
    const Vec3f motion = step_ - now_.material.at(position_);
    const float impact = dot(motion, normal);
    const Vec3f slide = apply_friction(motion - normal * impact, normal, now_.friction * std::fabs(impact));
    return Placement{target, now_.material.at(target) + slide};
}

std::optional<Placement> SweptParticle::taken_back() const {
    if (!was_free_) return std::nullopt;
    const Vec3f moved_along = now_.body.point_to_world(now_.to_body(free_local_));
    const Contact nearest = stretched_contact(now_.map, free_local_, now_.thickness, now_.scale);
    const Vec3f out = now_.body.normal_to_world(nearest.normal);
    // Rounding to floats may cross a surface that is very near, so the particle is moved away from it by
    // increasing distances.
    float gap = 0;
    for (int attempt = 0; attempt < 16; ++attempt) {
        const Vec3f target = moved_along + out * gap;
        if (is_free_at(now_.local.point_to_local(target))) return Placement{target, now_.material.at(target)};
        gap = gap == 0 ? now_.step / 2 : 2 * gap;
    }
    return std::nullopt;
}

} // namespace echinus
