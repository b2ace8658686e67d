// The proof that particles are free, and the way back for those that are not.

#include "simulation/contact_response.hpp"
#include "simulation/exact_collision.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

std::span<const std::uint32_t> ExactCollision::find_unsettled(const Particles& particles) {
    if (moves_) {
        const FrameChange before(frame_start_pose_, {1, 1, 1});
        for (std::size_t i = 0; i < particles.count(); ++i)
            carried_.set(i, now_.body.point_to_world(before.point_to_local(particles.frame_start[i])));
    }
    const PointArrays& free_now = moves_ ? carried_ : particles.frame_start;
    unsettled_.count = 0;
    list_unproven(known_, now_, particles.positions, free_now, unsettled_);
    // What was just compared with the frame's start says nothing about these.
    for (const std::uint32_t i : free_places_.exceptions())
        if (proven(known_, now_, i, particles.positions[i], free_now[i])) unsettled_.add(i);
    const auto is_settled = [&](std::uint32_t i) { return particles.pinned(i) || settled(i, particles); };
    const auto begin = unsettled_.particles.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(unsettled_.count);
    unsettled_.count = static_cast<std::size_t>(std::remove_if(begin, end, is_settled) - begin);
    return unsettled_.all();
}

bool ExactCollision::way_is_free(std::size_t i, const Particles& particles,
                                 const Vec3f& position_local) const {
    if (sweep(now_.map, free_places_.local(i, particles), position_local).found()) return false;
    // In a closed surface the sweep's silence says this too.
    return now_.map.border.empty() || !contains(now_.map, position_local);
}

bool ExactCollision::settled(std::size_t i, const Particles& particles) const {
    const Vec3f position = particles.positions[i];
    if (!free_places_.has(i)) return now_.outside(position);
    const Vec3f position_local = now_.local.point_to_local(position);
    if (!way_is_free(i, particles, position_local)) return false;
    return !contact(now_.map, position_local, now_.guard, now_.scale).found();
}

bool ExactCollision::strayed(std::size_t i, const Particles& particles) const {
    return free_places_.has(i) &&
           !way_is_free(i, particles, now_.local.point_to_local(particles.positions[i]));
}

bool ExactCollision::rescue(std::size_t i, Particles& particles) const {
    if (!free_places_.has(i)) return lead_out(i, particles);
    const Vec3f free_local = free_places_.local(i, particles);
    const Vec3f position_local = now_.local.point_to_local(particles.positions[i]);
    const SweepHit hit = sweep(now_.map, free_local, position_local);
    if (hit.found()) {
        const Vec3f normal = free_normal(free_local, hit, position_local);
        for (const float gap : {now_.thickness, now_.thickness / 8, 4 * now_.guard, 2 * now_.guard})
            if (leave(i, now_.to_body(hit.point) + normal * gap, normal, particles)) return true;
    } else {
        const Contact nearest = contact(now_.map, position_local, now_.guard, now_.scale);
        for (const float gap : {4 * now_.guard, 2 * now_.guard})
            if (nearest.found() &&
                leave(i, now_.to_body(nearest.point) + nearest.normal * gap, nearest.normal, particles))
                return true;
        if (way_is_free(i, particles, position_local)) return true; // in a narrow place, but free
    }
    return carry(i, particles);
}

/// A particle that began inside: to the nearest point, and beyond.
bool ExactCollision::lead_out(std::size_t i, Particles& particles) const {
    const Vec3f position = particles.positions[i];
    if (now_.outside(position)) return true;
    const Contact nearest = contact(now_.map, now_.local.point_to_local(position), 0, now_.scale);
    for (const float gap : {now_.thickness, now_.thickness / 8, 4 * now_.guard, 2 * now_.guard})
        if (leave(i, now_.to_body(nearest.point) + nearest.normal * gap, nearest.normal, particles))
            return true;
    return false;
}

/// Tries a place: the particle goes there if it is free there after rounding. Of its motion the part along
/// the surface remains, less friction.
bool ExactCollision::leave(std::size_t i, const Vec3f& target_body, const Vec3f& normal_body,
                           Particles& particles) const {
    const Vec3f target = now_.body.point_to_world(target_body);
    const Vec3f target_local = now_.local.point_to_local(target);
    const bool was_free = free_places_.has(i);
    if (was_free ? !way_is_free(i, particles, target_local) : contains(now_.map, target_local)) return false;
    const Vec3f position = particles.positions[i];
    const Vec3f normal = now_.body.normal_to_world(normal_body);
    const Vec3f motion = position - particles.previous[i] - now_.material.at(position);
    const float impact = dot(motion, normal);
    const Vec3f slide = apply_friction(motion - normal * impact, normal, now_.friction * std::fabs(impact));
    particles.positions.set(i, target);
    particles.previous.set(i, target - now_.material.at(target) - slide);
    return true;
}

bool ExactCollision::carry(std::size_t i, Particles& particles) const {
    if (!free_places_.has(i)) return false;
    const Vec3f free_local = free_places_.local(i, particles);
    const Vec3f carried = now_.body.point_to_world(now_.to_body(free_local));
    const Contact nearest = contact(now_.map, free_local, now_.thickness, now_.scale);
    const Vec3f out = now_.body.normal_to_world(nearest.normal);
    // Rounding to float may lead through a surface that is very near: away from it, by more and more.
    float gap = 0;
    for (int attempt = 0; attempt < 16; ++attempt) {
        const Vec3f target = carried + out * gap;
        if (way_is_free(i, particles, now_.local.point_to_local(target))) {
            particles.positions.set(i, target);
            particles.previous.set(i, target - now_.material.at(target));
            return true;
        }
        gap = gap == 0 ? now_.step / 2 : 2 * gap;
    }
    return false;
}

bool ExactCollision::mark_lost(std::size_t i) {
    return free_places_.mark_lost(i);
}

void ExactCollision::end_frame(const Particles& particles) {
    free_places_.end_frame(now_, particles, keep_free_);
}

} // namespace echinus
