#include "simulation/exact_collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

/// Places are asked about in pieces that stay in the first-level cache.
constexpr std::size_t kPieceSize = 256;

} // namespace

ExactCollision::ExactCollision(const Collider& collider, const Particles& particles,
                               const SimulationOptions& options)
    : now_(collider, collider.pose, options), frame_start_pose_(collider.pose), known_(particles),
      free_places_(now_, particles), to_ask_(particles.count()), unsettled_(2 * particles.count()),
      keep_free_(options.keep_free) {
    carried_.resize(particles.count());
}

void ExactCollision::begin_frame(const Collider& collider) {
    frame_start_pose_ = collider.pose;
    free_places_.begin_frame(collider);
    moves_ = collider.moves();
}

void ExactCollision::begin_substep(const Collider& collider, const RigidTransform& previous_pose,
                                   const SimulationOptions& options) {
    now_ = ColliderNow(collider, previous_pose, options);
    if (moves_) known_.follow(now_);
}

void ExactCollision::relax(Particles& particles, SimulationProfile& profile) {
    to_ask_.count = 0;
    profile.contact_count += push_known(known_, now_, particles, to_ask_);
    if (to_ask_.count > 0) ask(particles, profile);
}

/// The nearest point now, or the crossing when the particle came through the surface since it was free last:
/// behind a thin plate the nearest point lies on the wrong side.
///
/// Particles with about the same reach are asked for together.
void ExactCollision::ask(Particles& particles, SimulationProfile& profile) {
    // Above 0 also where that is too little for a float, so that doubling gets somewhere.
    const float least_reach = std::max(2 * now_.thickness, std::numeric_limits<float>::min());
    float reach = least_reach;
    std::size_t left = 0;
    for (const std::uint32_t i : to_ask_.all()) {
        if (!meet_on_the_way(i, particles, now_.local.point_to_local(particles.positions[i]), profile))
            to_ask_.particles[left++] = i;
        else
            profile.contact_count += push_one(known_, now_, i, particles) ? 1 : 0;
    }
    std::array<std::uint32_t, kPieceSize> asked;
    std::array<Vec3f, kPieceSize> places;
    for (; left > 0; reach *= 2) {
        std::size_t count = 0, beyond = 0;
        const auto ask_piece = [&] {
            ask_for_nearest(std::span(asked).first(count), std::span(places).first(count), reach, particles,
                            profile);
            count = 0;
        };
        for (std::size_t n = 0; n < left; ++n) {
            const std::uint32_t i = to_ask_.particles[n];
            if (reach_of(i, particles) > reach) {
                to_ask_.particles[beyond++] = i;
                continue;
            }
            asked[count] = i;
            places[count++] = now_.local.point_to_local(particles.positions[i]);
            if (count == kPieceSize) ask_piece();
        }
        ask_piece();
        left = beyond;
    }
}

/// How far from the particle surface is looked for: what it may come to in the next relaxations, or twice as
/// far as there was none.
float ExactCollision::reach_of(std::size_t i, const Particles& particles) const {
    const float speed = length(particles.positions[i] - particles.previous[i]);
    const float needed = 2 * (now_.thickness + speed);
    const bool was_far = known_.height[i] == KnownContacts::kNoPlane && known_.clearance[i] > 0;
    return was_far ? std::max(needed, 2 * known_.clearance[i]) : needed;
}

void ExactCollision::ask_for_nearest(std::span<const std::uint32_t> asked,
                                     std::span<const Vec3f> places_local, float reach, Particles& particles,
                                     SimulationProfile& profile) {
    std::array<Contact, kPieceSize> contacts;
    contacts_batch(now_.map, places_local, reach, std::span(contacts).first(asked.size()), now_.scale);
    for (std::size_t n = 0; n < asked.size(); ++n) {
        remember(asked[n], particles.positions[asked[n]], contacts[n], reach);
        if (contacts[n].found()) profile.contact_count += push_one(known_, now_, asked[n], particles) ? 1 : 0;
    }
    profile.map_query_count += asked.size();
}

void ExactCollision::remember(std::size_t i, const Vec3f& position, const Contact& nearest, float reach) {
    if (!nearest.found()) return known_.remember(i, now_, position, reach);
    known_.remember(i, now_, position, nearest.inside ? 0 : -nearest.depth);
    const Vec3f over_plane = known_.asked_at_body[i] - now_.to_body(nearest.point);
    known_.remember_plane(i, now_, nearest.normal, dot(over_plane, nearest.normal));
}

bool ExactCollision::meet_on_the_way(std::size_t i, const Particles& particles, const Vec3f& position_local,
                                     SimulationProfile& profile) {
    if (!keep_free_ || !free_places_.has(i)) return false;
    const Vec3f position = particles.positions[i];
    if (length(position - known_.asked_at[i]) < known_.clearance[i]) return false;
    ++profile.map_query_count;
    const Vec3f free_local = free_places_.local(i, particles);
    const SweepHit hit = sweep(now_.map, free_local, position_local);
    if (!hit.found()) return false;
    const Vec3f normal = free_normal(free_local, hit, position_local);
    known_.remember(i, now_, position, 0);
    const Vec3f over_plane = known_.asked_at_body[i] - now_.to_body(hit.point);
    known_.remember_plane(i, now_, normal, dot(over_plane, normal));
    return true;
}

Vec3f ExactCollision::free_normal(const Vec3f& free_local, const SweepHit& hit, const Vec3f& to_local) const {
    const Vec3f normal = now_.local.scaled_normal(hit.normal);
    return dot(to_local - free_local, hit.normal) > 0 ? -normal : normal;
}

} // namespace echinus
