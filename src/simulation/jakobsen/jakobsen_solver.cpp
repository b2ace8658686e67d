#include "simulation/jakobsen/jakobsen_solver.hpp"

#include "simulation/stopwatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace echinus {

namespace {

/// The constraints in the deformable's order, without those between two pinned particles.
std::vector<JakobsenConstraint>
jakobsen_constraints(const Deformable& deformable,
                     const std::array<double, kConstraintKindCount>& stiffness) {
    std::vector<JakobsenConstraint> constraints;
    for (const DistanceConstraint& constraint : deformable.constraints) {
        const double inverse_mass_a = deformable.inverse_masses[constraint.a];
        const double inverse_mass_b = deformable.inverse_masses[constraint.b];
        const double sum = inverse_mass_a + inverse_mass_b;
        if (sum == 0) continue;
        // Jakobsen 2001, section 4.
        const double share = stiffness[static_cast<std::size_t>(constraint.kind)];
        constraints.push_back({constraint.a, constraint.b, constraint.rest_length,
                               static_cast<float>(share * inverse_mass_a / sum),
                               static_cast<float>(share * inverse_mass_b / sum)});
    }
    return constraints;
}

/// One relaxation of all constraints, in their order.
void relax(std::span<const JakobsenConstraint> constraints, PointArrays& positions) noexcept {
    for (const JakobsenConstraint& constraint : constraints) {
        const Vec3f a = positions[constraint.a], b = positions[constraint.b];
        const Vec3f across = b - a;
        // The smallest float avoids a division by zero for coincident particles, and is otherwise lost in
        // rounding.
        const float distance = std::sqrt(dot(across, across) + std::numeric_limits<float>::min());
        const Vec3f correction = across * (1 - constraint.rest_length / distance);
        positions.set(constraint.a, a + correction * constraint.share_a);
        positions.set(constraint.b, b - correction * constraint.share_b);
    }
}

/// x' = x + (1 - drag) (x - x_previous) + a dt^2 (Jakobsen 2001, section 2), for one coordinate.
/// @param mobility  1, or 0 for a pinned particle
void integrate_axis(float* __restrict positions, float* __restrict previous, const float* __restrict mobility,
                    std::size_t count, float keep, float fall) {
    for (std::size_t i = 0; i < count; ++i) {
        const float position = positions[i];
        const float way = (position - previous[i]) * keep * mobility[i];
        previous[i] = position;
        positions[i] = position + way + fall * mobility[i];
    }
}

} // namespace

void Wind::blow(std::span<const Triangle> faces, const Vec3f& wind_step, float share, Particles& particles) {
    gusts_.assign(particles.count(), Gust{});
    const auto step_of = [&](std::uint32_t i) { return particles.step(i); };
    for (const auto& [a, b, c] : faces) {
        const Vec3f pa = particles.positions[a], pb = particles.positions[b], pc = particles.positions[c];
        const Vec3f normal = cross(pb - pa, pc - pa);
        const float normal_sq = dot(normal, normal);
        if (!(normal_sq > 0)) continue;
        const Vec3f step = (step_of(a) + step_of(b) + step_of(c)) * (1.0F / 3);
        const Vec3f across = normal * (dot(wind_step - step, normal) / normal_sq);
        for (const std::uint32_t corner : {a, b, c}) gusts_[corner].add(across);
    }
    for (std::size_t i = 0; i < gusts_.size(); ++i)
        if (gusts_[i].face_count != 0 && !particles.pinned(i))
            particles.move_previous(i, -(gusts_[i].mean() * share));
}

JakobsenSolver::JakobsenSolver(Deformable deformable_in, std::vector<Collider> colliders_in,
                               const SimulationOptions& options_in)
    : Solver(std::move(deformable_in), std::move(colliders_in), options_in),
      particles_(deformable, options.time_step),
      constraints_(jakobsen_constraints(deformable, options.jakobsen().stiffness)),
      collisions_(deformable, colliders, particles_, options) {}

void JakobsenSolver::step() {
    const Workers::Session session(workers_);
    bounds_.require_sound();
    begin_frame();
    integrate();
    move_colliders();
    for (std::uint32_t iteration = 0; iteration < options.jakobsen().iteration_count; ++iteration) {
        relax_constraints();
        collide();
    }
    bounds_.require_ways(particles_, frame);
    keep_free();
    publish();
    bounds_.require_ends(particles_, frame);
    ++frame;
    judge_frame();
}

void JakobsenSolver::begin_frame() {
    particles_.frame_start = particles_.positions;
    // Velocities that callers set may have any size.
    bounds_.require_ways(particles_, frame);
    move_colliders_on();
}

void JakobsenSolver::integrate() {
    const Stopwatch stopwatch(profile.integration_seconds);
    const Vec3f fall(options.gravity * (options.time_step * options.time_step));
    const auto keep = static_cast<float>(1 - options.jakobsen().drag);
    const auto along = [&](std::vector<float> PointArrays::*axis, float fall_along) {
        integrate_axis((particles_.positions.*axis).data(), (particles_.previous.*axis).data(),
                       particles_.mobility.data(), particles_.count(), keep, fall_along);
    };
    along(&PointArrays::x, fall.x);
    along(&PointArrays::y, fall.y);
    along(&PointArrays::z, fall.z);
}

void JakobsenSolver::move_colliders() {
    const Stopwatch stopwatch(profile.collision_seconds);
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const RigidTransform previous_pose = colliders[i].pose;
        colliders[i].pose = pose_after(colliders[i], options.time_step);
        collisions_.begin_frame(i, colliders[i], previous_pose);
    }
    attachments_.follow(colliders, deforming_, 1, particles_.positions);
}

void JakobsenSolver::relax_constraints() {
    const Stopwatch stopwatch(profile.constraint_seconds);
    relax(constraints_, particles_.positions);
}

void JakobsenSolver::collide() {
    const Stopwatch stopwatch(profile.collision_seconds);
    collisions_.relax(particles_, profile, workers_);
}

void JakobsenSolver::keep_free() {
    const Stopwatch stopwatch(profile.collision_seconds);
    collisions_.keep_free(particles_, profile);
}

void JakobsenSolver::publish() {
    const Stopwatch stopwatch(profile.integration_seconds);
    particles_.positions.store(deformable.positions);
    publish_velocities();
}

void JakobsenSolver::publish_velocities() {
    const auto rate = static_cast<float>(1 / options.time_step);
    for (std::size_t i = 0; i < particles_.count(); ++i) deformable.velocities[i] = particles_.step(i) * rate;
}

void JakobsenSolver::judge_frame() {
    const Stopwatch stopwatch(profile.integration_seconds);
    float largest_motion_sq = 0;
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        const Vec3f motion = particles_.step(i);
        largest_motion_sq = std::max(largest_motion_sq, dot(motion, motion));
    }
    largest_speed = std::sqrt(double{largest_motion_sq}) / options.time_step;
    rest_.watch(deformable.positions, largest_speed);
}

/// The velocity is the displacement of the particle in the last frame.
void JakobsenSolver::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    if (particles_.pinned(particle)) return;
    particles_.set_velocity(particle, velocity * options.time_step);
    deformable.velocities[particle] = Vec3f(velocity);
}

void JakobsenSolver::blow(const Vec3d& wind, double rate) {
    // No more than the whole difference, however long a frame is.
    const auto share = static_cast<float>(std::min(rate * options.time_step, 1.0));
    wind_.blow(deformable.faces, Vec3f(wind * options.time_step), share, particles_);
    publish_velocities();
}

void JakobsenSolver::archive(StateArchive& state) {
    archive_counts(state);
    state.points(particles_.positions);
    state.points(particles_.previous);
    rest_.archive(state);
    archive_colliders(state);
    attachments_.archive(state, deforming_);
    collisions_.archive(state, colliders);
    if (state.reads()) publish();
}

} // namespace echinus
