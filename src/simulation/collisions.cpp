#include "simulation/collisions.hpp"

namespace echinus {

namespace {

/// A particle between colliders is rescued from one after the other, so many times.
constexpr int kPasses = 4;

/// A collider is away where it is at least so far.
constexpr double kAwayInThicknesses = 4;

} // namespace

Collisions::Collisions(const Deformable& deformable, const std::vector<Collider>& colliders,
                       const Particles& particles, const SimulationOptions& options)
    : broad_phase_(colliders), was_away_(colliders.size()), frame_start_poses_(colliders.size()),
      rescues_(options.keep_free) {
    for (std::size_t i = 0; i < colliders.size(); ++i)
        collisions_.push_back(make_collision(colliders[i], particles, let_through(deformable, i), options));
    unproven_.reserve(collisions_.size() * particles.count());
}

Collisions::Collisions(const Collisions& other)
    : broad_phase_(other.broad_phase_), was_away_(other.was_away_),
      frame_start_poses_(other.frame_start_poses_), rescues_(other.rescues_), has_lost_(other.has_lost_) {
    for (const auto& collision : other.collisions_) collisions_.push_back(collision->clone());
    unproven_.reserve(other.unproven_.capacity());
}

void Collisions::begin_frame(const std::vector<Collider>& colliders,
                             std::span<const SurfaceMotion* const> motions, const Particles& particles,
                             const SimulationOptions& options) {
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        if (motions[i] != nullptr) broad_phase_.deform(i, motions[i]->from, motions[i]->to);
    for (std::size_t i = 0; i < collisions_.size(); ++i) was_away_[i] = is_away(i) ? 1 : 0;
    broad_phase_.begin_frame(colliders, particles, options.time_step,
                             kAwayInThicknesses * options.thickness.value(), options.substep_count);
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        collisions_[i]->begin_frame(colliders[i], motions[i]);
        if (was_away_[i] != 0 && !is_away(i)) collisions_[i]->resume(colliders[i]);
        frame_start_poses_[i] = colliders[i].pose;
    }
}

void Collisions::begin_substep(std::vector<Collider>& colliders, double seconds) {
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        const RigidTransform previous_pose = colliders[i].pose;
        colliders[i].pose = pose_after(colliders[i], seconds);
        if (is_away(i)) continue;
        collisions_[i]->begin_substep(colliders[i], previous_pose);
    }
}

void Collisions::relax(Particles& particles, SimulationProfile& profile, LoadMeter* meter,
                       const Workers& workers) {
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        if (is_away(i)) continue;
        if (meter != nullptr) meter->note(particles);
        collisions_[i]->relax(particles, profile, workers);
        if (meter != nullptr) meter->charge(i, particles);
    }
    profile.query_count += collisions_.size() * particles.count();
}

/// As one substep that takes the whole frame.
const std::vector<std::size_t>& Collisions::meet_late(const std::vector<Collider>& colliders,
                                                      const Particles& particles) {
    const std::vector<std::size_t>& met = broad_phase_.end_frame(colliders, particles);
    for (const std::size_t i : met) {
        collisions_[i]->resume(colliders[i]);
        collisions_[i]->begin_substep(colliders[i], frame_start_poses_[i]);
    }
    return met;
}

void Collisions::keep_free(Particles& particles, SimulationProfile& profile, LoadMeter* meter) {
    prove(particles, rescues_, profile, meter);
    end_frames(particles);
}

void Collisions::end_frame(Particles& particles, bool was_squeezed, SimulationProfile& profile) {
    // A particle that was lost may be free again. None is rescued: a place that is free for a particle may be
    // none for its faces.
    if (was_squeezed || has_lost_) prove(particles, false, profile, nullptr);
    end_frames(particles);
}

void Collisions::end_frames(const Particles& particles) {
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        if (is_away(i))
            collisions_[i]->end_frame_away();
        else
            collisions_[i]->end_frame(particles);
}

void Collisions::archive(StateArchive& state, const std::vector<Collider>& colliders) {
    broad_phase_.archive(state);
    state.flag(has_lost_);
    for (std::size_t i = 0; i < collisions_.size(); ++i) collisions_[i]->archive(state, colliders[i]);
}

void Collisions::prove(Particles& particles, bool rescues, SimulationProfile& profile, LoadMeter* meter) {
    has_lost_ = false;
    unproven_.clear();
    for (std::size_t i = 0; i < collisions_.size(); ++i) {
        if (is_away(i)) continue;
        const auto found = collisions_[i]->find_unproven(particles);
        unproven_.insert(unproven_.end(), found.begin(), found.end());
    }
    for (const std::uint32_t particle : unproven_) {
        const bool was_lost = is_lost(particle, particles);
        if (rescues) {
            const std::size_t rescuer = rescue(particle, particles);
            if (meter != nullptr) meter->charge(rescuer, particle, particles);
        }
        if (is_lost(particle, particles)) {
            has_lost_ = true;
            profile.lost_count += mark_lost(particle, particles);
        } else if (was_lost) {
            ++profile.rescued_count;
        }
    }
}

/// @return the collider from which it was rescued, the last of several
std::size_t Collisions::rescue(std::uint32_t particle, Particles& particles) const {
    std::size_t rescuer = 0;
    bool is_proven = false;
    for (int pass = 0; pass < kPasses && !is_proven; ++pass) {
        is_proven = true;
        for (std::size_t i = 0; i < collisions_.size(); ++i) {
            if (is_away(i) || !collisions_[i]->is_unproven(particle, particles)) continue;
            is_proven = false;
            rescuer = i;
            collisions_[i]->rescue(particle, particles);
        }
    }
    if (is_proven || !is_lost(particle, particles)) return rescuer;
    for (std::size_t i = collisions_.size(); i-- > 0;) {
        if (is_away(i)) continue;
        collisions_[i]->take_back(particle, particles);
        if (!is_lost(particle, particles)) return i;
    }
    return rescuer;
}

/// To any of the colliders.
bool Collisions::is_lost(std::uint32_t particle, const Particles& particles) const {
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        if (!is_away(i) && collisions_[i]->is_lost(particle, particles)) return true;
    return false;
}

/// @return the number of colliders to which the particle is newly lost
std::size_t Collisions::mark_lost(std::uint32_t particle, const Particles& particles) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < collisions_.size(); ++i)
        if (!is_away(i) && collisions_[i]->is_lost(particle, particles) &&
            collisions_[i]->mark_lost(particle))
            ++count;
    return count;
}

} // namespace echinus
