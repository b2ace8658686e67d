// Forces from outside, given as changes of velocity between frames: a hand, and wind.

#include "simulation/solver.hpp"

#include <algorithm>

namespace echinus {

/// The velocity is what the particle moved in the last substep.
void Simulation::Solver::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    if (particles_.pinned(particle)) return;
    const Vec3f before(Vec3d(particles_.positions[particle]) - velocity * substep_seconds_);
    particles_.previous.set(particle, before);
    deformable.previous_positions[particle] = before;
}

/// The wind's velocity as seen from the particle, across the faces around it.
void Simulation::Solver::blow(const Vec3d& wind, double rate) {
    const Vec3f wind_way(wind * substep_seconds_);
    gusts_.assign(deformable.particle_count(), Gust{});
    for (const auto& [a, b, c] : deformable.faces) {
        const Vec3f pa = particles_.positions[a], pb = particles_.positions[b], pc = particles_.positions[c];
        const Vec3f normal = cross(pb - pa, pc - pa);
        const float normal_sq = dot(normal, normal);
        if (!(normal_sq > 0)) continue;
        const auto way_of = [&](std::uint32_t i) { return particles_.positions[i] - particles_.previous[i]; };
        const Vec3f way = (way_of(a) + way_of(b) + way_of(c)) * (1.0F / 3);
        const Vec3f across = normal * (dot(wind_way - way, normal) / normal_sq);
        for (const std::uint32_t corner : {a, b, c}) gusts_[corner].add(across);
    }
    // No more than all of the difference, however long a frame is.
    const auto share = static_cast<float>(std::min(rate * options.time_step, 1.0));
    for (std::size_t i = 0; i < gusts_.size(); ++i) {
        if (gusts_[i].face_count == 0 || particles_.pinned(i)) continue;
        const Vec3f before = particles_.previous[i] - gusts_[i].mean() * share;
        particles_.previous.set(i, before);
        deformable.previous_positions[i] = before;
    }
}

} // namespace echinus
