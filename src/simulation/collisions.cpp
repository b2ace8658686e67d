#include "simulation/collisions.hpp"

#include <algorithm>

namespace echinus {

namespace {

/// A particle between colliders is rescued from one after the other, so many times.
constexpr int kPasses = 4;

} // namespace

Collisions::Collisions(const std::vector<Collider>& colliders, const Particles& particles,
                       const SimulationOptions& options)
    : rescues_(options.keep_free) {
    for (const Collider& collider : colliders)
        collisions_.push_back(make_collision(collider, particles, options));
    unproven_.reserve(collisions_.size() * particles.count());
}

Collisions::Collisions(const Collisions& other) : rescues_(other.rescues_), has_lost_(other.has_lost_) {
    for (const auto& collision : other.collisions_) collisions_.push_back(collision->clone());
    unproven_.reserve(other.unproven_.capacity());
}

void Collisions::begin_frame(const std::vector<Collider>& colliders) {
    for (std::size_t i = 0; i < collisions_.size(); ++i) collisions_[i]->begin_frame(colliders[i]);
}

void Collisions::begin_substep(std::vector<Collider>& colliders, double seconds) {
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        const RigidTransform previous_pose = colliders[i].pose;
        colliders[i].pose = pose_after(colliders[i], seconds);
        collisions_[i]->begin_substep(colliders[i], previous_pose);
    }
}

void Collisions::relax(Particles& particles, SimulationProfile& profile) {
    for (const auto& collision : collisions_) collision->relax(particles, profile);
    profile.query_count += collisions_.size() * particles.count();
}

void Collisions::keep_free(Particles& particles, SimulationProfile& profile) {
    prove(particles, rescues_, profile);
    for (const auto& collision : collisions_) collision->end_frame(particles);
}

void Collisions::end_frame(Particles& particles, bool was_squeezed, SimulationProfile& profile) {
    // A particle that was lost may be free again. None is rescued: a place that is free for a particle may be
    // none for its faces.
    if (was_squeezed || has_lost_) prove(particles, false, profile);
    for (const auto& collision : collisions_) collision->end_frame(particles);
}

void Collisions::prove(Particles& particles, bool rescues, SimulationProfile& profile) {
    has_lost_ = false;
    unproven_.clear();
    for (const auto& collision : collisions_) {
        const auto found = collision->find_unproven(particles);
        unproven_.insert(unproven_.end(), found.begin(), found.end());
    }
    for (const std::uint32_t particle : unproven_) {
        const bool was_lost = is_lost(particle, particles);
        if (rescues) rescue(particle, particles);
        if (is_lost(particle, particles)) {
            has_lost_ = true;
            profile.lost_count += mark_lost(particle, particles);
        } else if (was_lost) {
            ++profile.rescued_count;
        }
    }
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
    if (is_proven || !is_lost(particle, particles)) return;
    for (auto collision = collisions_.rbegin(); collision != collisions_.rend(); ++collision) {
        (*collision)->take_back(particle, particles);
        if (!is_lost(particle, particles)) return;
    }
}

/// To any of the colliders.
bool Collisions::is_lost(std::uint32_t particle, const Particles& particles) const {
    return std::any_of(collisions_.begin(), collisions_.end(),
                       [&](const auto& collision) { return collision->is_lost(particle, particles); });
}

/// @return the number of colliders to which the particle is newly lost
std::size_t Collisions::mark_lost(std::uint32_t particle, const Particles& particles) {
    return static_cast<std::size_t>(
        std::count_if(collisions_.begin(), collisions_.end(), [&](const auto& collision) {
            return collision->is_lost(particle, particles) && collision->mark_lost(particle);
        }));
}

} // namespace echinus
