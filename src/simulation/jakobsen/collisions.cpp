#include "simulation/jakobsen/collisions.hpp"

#include "simulation/jakobsen/contact_collision.hpp"
#include "simulation/jakobsen/exact_collision.hpp"

#include <algorithm>
#include <variant>

namespace echinus {

namespace {

/// How often a particle between colliders is rescued from each of them in turn.
constexpr int kPasses = 4;

/// Depends on the kind of the collider's map. @pre the collider is valid, and the options have a thickness
/// @param passes  [particle_count] 1 for particles that the collider lets through; or empty
std::unique_ptr<Collision> make_collision(const Collider& collider, const Particles& particles,
                                          std::span<const std::uint8_t> passes,
                                          const SimulationOptions& options) {
    if (std::holds_alternative<ExactMap>(collider.map.kind))
        return std::make_unique<ExactCollision>(collider, particles, passes, options);
    return std::make_unique<ContactCollision>(collider, particles, passes, options);
}

} // namespace

Collisions::Collisions(const Deformable& deformable, const std::vector<Collider>& colliders,
                       const Particles& particles, const SimulationOptions& options)
    : rescues_(options.jakobsen().keep_free) {
    for (std::size_t i = 0; i < colliders.size(); ++i)
        collisions_.push_back(make_collision(colliders[i], particles, let_through(deformable, i), options));
    is_away_.resize(collisions_.size());
    unproven_.reserve(collisions_.size() * particles.count());
}

Collisions::Collisions(const Collisions& other) : is_away_(other.is_away_), rescues_(other.rescues_) {
    for (const auto& collision : other.collisions_) collisions_.push_back(collision->clone());
    unproven_.reserve(other.unproven_.capacity());
}

void Collisions::restart(std::span<const std::uint32_t> particles, const Particles& now) {
    for (const auto& collision : collisions_) collision->restart(particles, now);
}

void Collisions::leave_out_away(const Particles& particles) {
    const std::size_t count = particles.count();
    AlignedBox<double> starts, ends;
    for (std::size_t i = 0; i < count; ++i) {
        starts.add(Vec3d(particles.frame_start[i]));
        ends.add(Vec3d(particles.positions[i]));
    }
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        is_away_[i] = count == 0 || collisions_[i]->is_away(starts, ends) ? 1 : 0;
}

void Collisions::relax(Particles& particles, SimulationProfile& profile, const Workers& workers) {
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        if (is_away_[i] == 0) collisions_[i]->relax(particles, profile, workers);
    profile.query_count += collisions_.size() * particles.count();
}

void Collisions::keep_free(Particles& particles, SimulationProfile& profile) {
    unproven_.clear();
    // A particle that one collider has pushed may be near another.
    if (std::find(is_away_.begin(), is_away_.end(), 1) != is_away_.end()) leave_out_away(particles);
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        if (is_away_[i] != 0) continue;
        const auto found = collisions_[i]->find_unproven(particles);
        unproven_.insert(unproven_.end(), found.begin(), found.end());
    }
    for (const std::uint32_t particle : unproven_) {
        const bool was_lost = is_lost(particle, particles);
        if (rescues_) rescue(particle, particles);
        if (is_lost(particle, particles))
            profile.lost_count += mark_lost(particle, particles);
        else if (was_lost)
            ++profile.rescued_count;
    }
    for (const auto& collision : collisions_) collision->end_frame(particles);
}

Vec3d Collisions::without_approach(std::size_t particle, const Particles& particles, Vec3d motion) const {
    for (const auto& collision : collisions_)
        motion = collision->without_approach(particle, particles, motion);
    return motion;
}

void Collisions::archive(StateArchive& state, const std::vector<Collider>& colliders) {
    for (std::size_t i = 0; i < collisions_.size(); ++i) collisions_[i]->archive(state, colliders[i]);
}

void Collisions::rescue(std::uint32_t particle, Particles& particles) const {
    bool is_proven = false;
    for (int pass = 0; pass < kPasses && !is_proven; ++pass) {
        is_proven = true;
        for (const auto& collision : collisions_) {
            if (!collision->is_unproven(particle, particles)) continue;
            is_proven = false;
            collision->rescue(particle, particles);
        }
    }
    if (is_proven) return;
    for (std::size_t i = collisions_.size(); i-- > 0 && is_lost(particle, particles);)
        collisions_[i]->take_back(particle, particles);
}

/// Whether the particle is lost to any of the colliders.
bool Collisions::is_lost(std::uint32_t particle, const Particles& particles) const {
    return std::any_of(collisions_.begin(), collisions_.end(),
                       [&](const auto& collision) { return collision->is_lost(particle, particles); });
}

/// @return the number of colliders to which the particle is newly lost
std::size_t Collisions::mark_lost(std::uint32_t particle, const Particles& particles) {
    std::size_t count = 0;
    for (const auto& collision : collisions_)
        if (collision->is_lost(particle, particles) && collision->mark_lost(particle)) ++count;
    return count;
}

} // namespace echinus
