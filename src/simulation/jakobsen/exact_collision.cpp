#include "simulation/jakobsen/exact_collision.hpp"

#include "exact_map/query/stretched_contact.hpp"
#include "geometry/parallel.hpp"
#include "simulation/jakobsen/contact_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace echinus {

namespace {

/// Positions are queried in pieces that fit into the first-level cache.
constexpr std::size_t kPieceSize = 256;

/// The number of particles that make a piece of work if several threads share them.
constexpr std::size_t kSharedSize = 2048;

/// A share of the coordinates that exceeds the rounding of floats when boxes change frames.
constexpr double kRoundingOfBoxes = 1e-5;

} // namespace

ExactCollision::ExactCollision(const Collider& collider, const Particles& particles,
                               std::span<const std::uint8_t> passes, const SimulationOptions& options)
    : options_(options), now_(collider, collider.pose, options), pose_(collider.pose),
      frame_start_pose_(collider.pose), known_pose_(collider.pose), known_(particles, passes),
      free_places_(now_, particles, passes), unproven_(2 * particles.count()) {
    const bool is_shared = worker_count(options.thread_count) > 1;
    const std::size_t most = is_shared ? kSharedSize : std::max<std::size_t>(particles.count(), 1);
    pieces_.assign(Workers::piece_count(particles.count(), most), Piece{ParticleList(most)});
    moved_along_.resize(particles.count());
}

void ExactCollision::restart(std::span<const std::uint32_t> restarted, const Particles& particles) {
    for (const std::uint32_t i : restarted) known_.forget(i, particles.pinned(i));
    free_places_.restart(restarted, now_, particles);
}

void ExactCollision::begin_frame(const Collider& collider, const RigidTransform& previous_pose) {
    frame_start_pose_ = previous_pose;
    free_places_.begin_frame(collider, previous_pose);
    moves_ = collider.pose != previous_pose;
    now_ = ColliderNow(collider, previous_pose, options_);
    pose_ = collider.pose;
}

bool ExactCollision::is_away(const AlignedBox<double>& starts, const AlignedBox<double>& ends) const {
    AlignedBox<double> places; // of all particle paths, in the map's frame
    const auto add = [&](const AlignedBox<double>& box, const FrameChange& frame) {
        for (int corner = 0; corner < 8; ++corner)
            places.add(Vec3d(frame.point_to_local(Vec3d{(corner & 1) != 0 ? box.high.x : box.low.x,
                                                        (corner & 2) != 0 ? box.high.y : box.low.y,
                                                        (corner & 4) != 0 ? box.high.z : box.low.z})));
    };
    add(starts, FrameChange(frame_start_pose_, now_.scale));
    add(ends, now_.local);
    const double rounding = kRoundingOfBoxes * places.largest_coordinate();
    const double reach = 2 * double{now_.thickness} / now_.local.least_scale() + rounding;
    return places.distance(Vec3d(now_.map.centre)) > (1 + kRoundingOfBoxes) * double{now_.map.radius} + reach;
}

/// Makes known contacts follow a collider that has moved; called only when they are needed.
void ExactCollision::follow() {
    if (pose_ == known_pose_) return;
    known_.follow(now_);
    known_pose_ = pose_;
}

void ExactCollision::archive(StateArchive& state, const Collider& collider) {
    if (state.reads()) {
        now_ = ColliderNow(collider, collider.pose, options_);
        pose_ = known_pose_ = collider.pose;
    }
    known_.archive(state);
    free_places_.archive(state);
}

void ExactCollision::relax(Particles& particles, SimulationProfile& profile, const Workers& workers) {
    follow();
    const std::size_t size = pieces_.size() > 1 ? kSharedSize : std::max<std::size_t>(particles.count(), 1);
    workers.for_ranges(particles.count(), size,
                       [&](std::size_t, std::size_t piece, std::size_t first, std::size_t end) {
                           relax(first, end, particles, pieces_[piece]);
                       });
    for (const Piece& piece : pieces_) {
        profile.contact_count += piece.contact_count;
        profile.map_query_count += piece.map_query_count;
    }
}

/// No particle's answer depends on another's.
void ExactCollision::relax(std::size_t first, std::size_t end, Particles& particles, Piece& piece) {
    piece.to_ask.count = 0;
    piece.map_query_count = 0;
    piece.contact_count = push_known(known_, now_, first, end, particles, piece.to_ask);
    if (piece.to_ask.count > 0) ask(particles, piece);
}

/// Finds the nearest point, or the crossing if the particle came through the surface since it was last free:
/// behind a thin plate the nearest point is on the wrong side.
///
/// Particles with about the same reach are queried together.
void ExactCollision::ask(Particles& particles, Piece& piece) {
    ParticleList& to_ask = piece.to_ask;
    // Positive even if twice the thickness underflows, so that doubling has an effect.
    const float least_reach = std::max(2 * now_.thickness, std::numeric_limits<float>::min());
    float reach = least_reach;
    std::size_t left = 0;
    for (const std::uint32_t i : to_ask.all()) {
        if (!meet_on_the_way(i, particles, piece))
            to_ask.particles[left++] = i;
        else
            piece.contact_count += push_one(known_, now_, i, particles) ? 1 : 0;
    }
    std::array<std::uint32_t, kPieceSize> asked;
    std::array<Vec3f, kPieceSize> places;
    for (; left > 0; reach *= 2) {
        std::size_t count = 0, beyond = 0;
        const auto ask_piece = [&] {
            ask_for_nearest(std::span(asked).first(count), std::span(places).first(count), reach, particles,
                            piece);
            count = 0;
        };
        for (std::size_t n = 0; n < left; ++n) {
            const std::uint32_t i = to_ask.particles[n];
            if (reach_of(i, particles) > reach) {
                to_ask.particles[beyond++] = i;
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

/// How far from the particle the map looks for surface: as far as the particle may move in the next
/// relaxations, or twice the last reach if nothing was found within that.
float ExactCollision::reach_of(std::size_t i, const Particles& particles) const {
    const float speed = length(particles.step(i));
    const float needed = 2 * (now_.thickness + speed);
    const bool was_far = known_.height[i] == KnownContacts::kNoPlane && known_.clearance[i] > 0;
    return was_far ? std::max(needed, 2 * known_.clearance[i]) : needed;
}

void ExactCollision::ask_for_nearest(std::span<const std::uint32_t> asked,
                                     std::span<const Vec3f> places_local, float reach, Particles& particles,
                                     Piece& piece) {
    std::array<Contact, kPieceSize> contacts;
    stretched_contacts_batch(now_.map, places_local, reach, std::span(contacts).first(asked.size()),
                             now_.scale);
    for (std::size_t n = 0; n < asked.size(); ++n) {
        remember(asked[n], particles.positions[asked[n]], contacts[n], reach);
        if (contacts[n].found()) piece.contact_count += push_one(known_, now_, asked[n], particles) ? 1 : 0;
    }
    piece.map_query_count += asked.size();
}

void ExactCollision::remember(std::size_t i, const Vec3f& position, const Contact& nearest, float reach) {
    if (!nearest.found()) return known_.remember(i, now_, position, reach);
    known_.remember(i, now_, position, nearest.inside ? 0 : std::fabs(nearest.depth));
    const Vec3f over_plane = known_.asked_at_body[i] - now_.to_body(nearest.point);
    known_.remember_plane(i, now_, nearest.normal, dot(over_plane, nearest.normal));
}

bool ExactCollision::meet_on_the_way(std::size_t i, const Particles& particles, Piece& piece) {
    if (!options_.jakobsen().keep_free || !free_places_.has(i)) return false;
    const Vec3f position = particles.positions[i];
    if (length(position - known_.asked_at[i]) < known_.clearance[i]) return false;
    ++piece.map_query_count;
    const SweptParticle particle = swept(i, particles);
    const SweepHit hit = particle.crossing();
    if (!hit.found()) return false;
    const Vec3f normal = particle.free_normal(hit);
    known_.remember(i, now_, position, 0);
    const Vec3f over_plane = known_.asked_at_body[i] - now_.to_body(hit.point);
    known_.remember_plane(i, now_, normal, dot(over_plane, normal));
    return true;
}

Vec3d ExactCollision::without_approach(std::size_t i, const Particles& particles, const Vec3d& motion) const {
    const Vec3f position = particles.positions[i], normal = known_.normal[i];
    const float over = known_.height[i] + dot(position - known_.asked_at[i], normal);
    if (!(over <= kTouchInThicknesses * now_.thickness)) return motion;
    const Vec3d material(now_.material.at(position));
    return material + stopped_motion(motion - material, normal, now_.friction);
}

std::span<const std::uint32_t> ExactCollision::find_unproven(const Particles& particles) {
    follow();
    if (moves_) {
        const FrameChange before(frame_start_pose_, {1, 1, 1});
        for (std::size_t i = 0; i < particles.count(); ++i)
            moved_along_.set(i, now_.body.point_to_world(before.point_to_local(particles.frame_start[i])));
    }
    const PointArrays& free_now = moves_ ? moved_along_ : particles.frame_start;
    unproven_.count = 0;
    list_unproven(known_, now_, particles.positions, free_now, unproven_);
    // These were compared with their positions at the start of the frame, not with those where they were last
    // free.
    for (const std::uint32_t i : free_places_.exceptions())
        if (is_known_free(known_, now_, i, particles.positions[i], free_now[i])) unproven_.add(i);
    const auto is_proven = [&](std::uint32_t i) { return particles.pinned(i) || !is_unproven(i, particles); };
    const auto begin = unproven_.particles.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(unproven_.count);
    unproven_.count = static_cast<std::size_t>(std::remove_if(begin, end, is_proven) - begin);
    return unproven_.all();
}

bool ExactCollision::is_unproven(std::size_t i, const Particles& particles) const {
    return !known_.is_never_asked(i) && swept(i, particles).is_unproven();
}

bool ExactCollision::is_lost(std::size_t i, const Particles& particles) const {
    return !known_.is_never_asked(i) && free_places_.has(i) && swept(i, particles).is_lost();
}

void ExactCollision::rescue(std::size_t i, Particles& particles) const {
    if (const auto place = swept(i, particles).rescued()) particles.put(i, *place);
}

void ExactCollision::take_back(std::size_t i, Particles& particles) const {
    if (const auto place = swept(i, particles).taken_back()) particles.put(i, *place);
}

void ExactCollision::end_frame(const Particles& particles) {
    free_places_.end_frame(now_, particles, options_.jakobsen().keep_free);
}

} // namespace echinus
