// The proof at the end of a frame that no particle passed through a collider with an exact map.

#include "simulation/exact_collision.hpp"
#include "simulation/solver.hpp"
#include "simulation/stopwatch.hpp"

#include <echinus/simulation.hpp>

#include <variant>

namespace echinus {

namespace {

/// A particle between colliders is led out of one after the other, so many times.
constexpr int kPasses = 4;

} // namespace

void Simulation::Solver::remember_free_places(std::size_t collider_index) {
    exact_.push_back(collider_index);
    memories_[collider_index].resize(particles_.count());
    const ExactCollision collision = collision_with(collider_index);
    for (std::size_t i = 0; i < particles_.count(); ++i)
        collision.begin(memories_[collider_index][i], particles_.positions[i]);
}

void Simulation::Solver::keep_free() {
    const Stopwatch stopwatch(profile.collision_seconds);
    unsettled_.clear();
    for (const std::size_t c : exact_) {
        const ExactCollision collision = collision_with(c);
        for (std::uint32_t i = 0; i < particles_.count(); ++i)
            if (!particles_.pinned(i) && !collision.settled(memories_[c][i], particles_.positions[i]))
                unsettled_.push_back(i);
    }
    for (const std::uint32_t particle : unsettled_) {
        if (options.keep_free) lead_to_free_place(particle);
        count_lost(particle);
    }
    commit_free_places();
}

void Simulation::Solver::lead_to_free_place(std::uint32_t particle) {
    Vec3f position = particles_.positions[particle];
    Vec3f previous = particles_.previous[particle];
    find_free_place(particle, position, previous);
    particles_.positions.set(particle, position);
    particles_.previous.set(particle, previous);
}

void Simulation::Solver::find_free_place(std::uint32_t particle, Vec3f& position, Vec3f& previous) {
    for (const std::size_t c : exact_) {
        const SurfaceMemory& memory = memories_[c][particle];
        if (memory.was_free && !collision_with(c).free_at(memory, position)) ++profile.rescued_count;
    }
    bool all_settled = false;
    for (int pass = 0; pass < kPasses && !all_settled; ++pass) {
        all_settled = true;
        for (const std::size_t c : exact_) {
            const ExactCollision collision = collision_with(c);
            if (collision.settled(memories_[c][particle], position)) continue;
            all_settled = false;
            collision.rescue(memories_[c][particle], position, previous);
        }
    }
    if (all_settled || is_free(particle, position)) return;
    for (auto c = exact_.rbegin(); c != exact_.rend(); ++c) {
        collision_with(*c).carry(memories_[*c][particle], position, previous);
        if (is_free(particle, position)) return;
    }
}

bool Simulation::Solver::is_free(std::uint32_t particle, const Vec3f& position) const {
    for (const std::size_t c : exact_) {
        const SurfaceMemory& memory = memories_[c][particle];
        if (memory.was_free && !collision_with(c).free_at(memory, position)) return false;
    }
    return true;
}

void Simulation::Solver::count_lost(std::uint32_t particle) {
    for (const std::size_t c : exact_) {
        SurfaceMemory& memory = memories_[c][particle];
        if (memory.lost || !memory.was_free) continue; // counted already, or it began inside
        memory.lost = !collision_with(c).free_at(memory, particles_.positions[particle]);
        profile.lost_count += memory.lost ? 1 : 0;
    }
}

/// What is lost is judged by its last free place in the next frame again, unless nobody wants it back: then
/// each frame is judged for itself.
void Simulation::Solver::commit_free_places() {
    for (const std::size_t c : exact_) {
        const ExactCollision collision = collision_with(c);
        for (std::size_t i = 0; i < particles_.count(); ++i) {
            SurfaceMemory& memory = memories_[c][i];
            const Vec3f position = particles_.positions[i];
            const bool sure = memory.was_free && !memory.lost;
            if (sure || ((!memory.lost || !options.keep_free) && collision.outside(position)))
                collision.commit(memory, position);
            memory.lost = false;
        }
    }
}

} // namespace echinus
