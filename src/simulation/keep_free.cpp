// The proof at the end of a frame that no particle passed through a collider with an exact map.

#include "simulation/solver.hpp"
#include "simulation/stopwatch.hpp"

#include <algorithm>

namespace echinus {

namespace {

/// A particle between colliders is led out of one after the other, so many times.
constexpr int kPasses = 4;

} // namespace

void Simulation::Solver::keep_free() {
    const Stopwatch stopwatch(profile.collision_seconds);
    unsettled_.clear();
    for (ExactCollision& collision : exact_) {
        const auto found = collision.find_unsettled(particles_);
        unsettled_.insert(unsettled_.end(), found.begin(), found.end());
    }
    for (const std::uint32_t particle : unsettled_) {
        if (options.keep_free) lead_to_free_place(particle);
        count_lost(particle);
    }
    for (ExactCollision& collision : exact_) collision.end_frame(particles_);
}

void Simulation::Solver::lead_to_free_place(std::uint32_t particle) {
    for (const ExactCollision& collision : exact_)
        if (collision.strayed(particle, particles_)) ++profile.rescued_count;
    bool all_settled = false;
    for (int pass = 0; pass < kPasses && !all_settled; ++pass) {
        all_settled = true;
        for (const ExactCollision& collision : exact_) {
            if (collision.settled(particle, particles_)) continue;
            all_settled = false;
            collision.rescue(particle, particles_);
        }
    }
    if (all_settled || is_free(particle)) return;
    for (auto collision = exact_.rbegin(); collision != exact_.rend(); ++collision) {
        collision->carry(particle, particles_);
        if (is_free(particle)) return;
    }
}

bool Simulation::Solver::is_free(std::uint32_t particle) const {
    return std::none_of(exact_.begin(), exact_.end(), [&](const ExactCollision& collision) {
        return collision.strayed(particle, particles_);
    });
}

void Simulation::Solver::count_lost(std::uint32_t particle) {
    for (ExactCollision& collision : exact_)
        if (collision.strayed(particle, particles_) && collision.mark_lost(particle)) ++profile.lost_count;
}

} // namespace echinus
