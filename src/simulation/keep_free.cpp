// The proof at the end of a frame that no particle passed through a collider with an exact map.

#include "simulation/exact_collision.hpp"
#include "simulation/stopwatch.hpp"

#include <echinus/simulation.hpp>

#include <variant>

namespace echinus {

namespace {

/// A particle between colliders is led out of one after the other, so many times.
constexpr int kPasses = 4;

} // namespace

void Simulation::remember_free_places(std::size_t collider_index) {
    exact_.push_back(collider_index);
    memories_[collider_index].resize(deformable_.particle_count());
    const ExactCollision collision = collision_with(collider_index);
    for (std::size_t i = 0; i < deformable_.particle_count(); ++i)
        collision.begin(memories_[collider_index][i], deformable_.positions[i]);
}

void Simulation::keep_free() {
    const Stopwatch stopwatch(profile_.collision_seconds);
    unsettled_.clear();
    for (const std::size_t c : exact_) {
        const ExactCollision collision = collision_with(c);
        for (std::uint32_t i = 0; i < deformable_.particle_count(); ++i)
            if (deformable_.inverse_masses[i] != 0 &&
                !collision.settled(memories_[c][i], deformable_.positions[i]))
                unsettled_.push_back(i);
    }
    for (const std::uint32_t particle : unsettled_) {
        if (options_.keep_free) lead_to_free_place(particle);
        count_lost(particle);
    }
    commit_free_places();
}

void Simulation::lead_to_free_place(std::uint32_t particle) {
    Vec3f& position = deformable_.positions[particle];
    Vec3f& previous = deformable_.previous_positions[particle];
    for (const std::size_t c : exact_) {
        const SurfaceMemory& memory = memories_[c][particle];
        if (memory.was_free && !collision_with(c).free_at(memory, position)) ++profile_.rescued_count;
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
    if (all_settled || is_free(particle)) return;
    for (auto c = exact_.rbegin(); c != exact_.rend(); ++c) {
        collision_with(*c).carry(memories_[*c][particle], position, previous);
        if (is_free(particle)) return;
    }
}

bool Simulation::is_free(std::uint32_t particle) const {
    for (const std::size_t c : exact_) {
        const SurfaceMemory& memory = memories_[c][particle];
        if (memory.was_free && !collision_with(c).free_at(memory, deformable_.positions[particle]))
            return false;
    }
    return true;
}

void Simulation::count_lost(std::uint32_t particle) {
    for (const std::size_t c : exact_) {
        SurfaceMemory& memory = memories_[c][particle];
        if (memory.lost || !memory.was_free) continue; // counted already, or it began inside
        memory.lost = !collision_with(c).free_at(memory, deformable_.positions[particle]);
        profile_.lost_count += memory.lost ? 1 : 0;
    }
}

/// What is lost is judged by its last free place in the next frame again, unless nobody wants it back: then
/// each frame is judged for itself.
void Simulation::commit_free_places() {
    for (const std::size_t c : exact_) {
        const ExactCollision collision = collision_with(c);
        for (std::size_t i = 0; i < deformable_.particle_count(); ++i) {
            SurfaceMemory& memory = memories_[c][i];
            const Vec3f& position = deformable_.positions[i];
            const bool sure = memory.was_free && !memory.lost;
            if (sure || ((!memory.lost || !options_.keep_free) && collision.outside(position)))
                collision.commit(memory, position);
            memory.lost = false;
        }
    }
}

} // namespace echinus
