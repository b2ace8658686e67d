#include "collider/frame_change.hpp"
#include "simulation/contact_response.hpp"
#include "simulation/exact_collision.hpp"
#include "simulation/material_motion.hpp"
#include "simulation/stopwatch.hpp"
#include "simulation/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>

namespace echinus {

namespace {

Sphere box_sphere(std::span<const Vec3f> points) {
    Vec3d low(points.front());
    Vec3d high = low;
    for (const Vec3f& p : points) {
        low = {std::min(low.x, double{p.x}), std::min(low.y, double{p.y}), std::min(low.z, double{p.z})};
        high = {std::max(high.x, double{p.x}), std::max(high.y, double{p.y}), std::max(high.z, double{p.z})};
    }
    return {(low + high) * 0.5, length(high - low) / 2};
}

bool is_exact(const Collider& collider) {
    return std::holds_alternative<ExactMap>(collider.map);
}

/// Contacts are asked for in pieces that stay in the first-level cache.
constexpr std::size_t kPieceSize = 256;

} // namespace

Simulation::Simulation(Deformable deformable, std::vector<Collider> colliders,
                       const SimulationOptions& options)
    : deformable_(std::move(deformable)), colliders_(std::move(colliders)), options_(options),
      largest_speed_(std::numeric_limits<double>::infinity()) {
    require_valid(options_);
    require_valid(deformable_);
    require_valid(colliders_);
    for (const Collider& collider : colliders_) previous_poses_.push_back(collider.pose);
    memories_.resize(colliders_.size());
    for (std::size_t i = 0; i < colliders_.size(); ++i)
        if (is_exact(colliders_[i])) remember_free_places(i);
    unsettled_.reserve(exact_.size() * deformable_.particle_count());
    weighted_sticks_ = weigh(deformable_, options_);
    resting_places_ = deformable_.positions;
    const Sphere start = box_sphere(deformable_.positions);
    start_centre_ = start.centre;
    // A single particle has no extent; its bound is then in the caller's unit.
    bound_ = options_.bound > 0 ? options_.bound : 1e4 * (start.radius > 0 ? 2 * start.radius : 1);
}

std::vector<Simulation::WeightedStick> Simulation::weigh(const Deformable& deformable,
                                                         const SimulationOptions& options) {
    std::vector<WeightedStick> weighted;
    weighted.reserve(deformable.sticks.size());
    for (const Stick& stick : deformable.sticks) {
        const double mass_a = deformable.inverse_masses[stick.a];
        const double mass_b = deformable.inverse_masses[stick.b];
        if (mass_a + mass_b == 0) continue; // both pinned
        const double stiffness = options.stiffness[static_cast<std::size_t>(stick.kind)];
        weighted.push_back({stick.a, stick.b, stick.rest_length,
                            static_cast<float>(stiffness * mass_a / (mass_a + mass_b)),
                            static_cast<float>(stiffness * mass_b / (mass_a + mass_b))});
    }
    return weighted;
}

void Simulation::step() {
    integrate();
    for (std::uint32_t iteration = 0; iteration < options_.iteration_count; ++iteration) {
        relax_sticks();
        for (std::size_t i = 0; i < colliders_.size(); ++i) collide(i);
    }
    keep_free();
    ++frame_;
    judge_frame();
}

void Simulation::set_velocities(std::size_t collider_index, const Vec3d& linear, const Vec3d& angular) {
    colliders_[collider_index].linear_velocity = linear;
    colliders_[collider_index].angular_velocity = angular;
}

/// x' = x + (1 - drag) (x - x_previous) + a dt^2 (Jakobsen 2001, section 2).
void Simulation::integrate() {
    const Stopwatch stopwatch(profile_.integration_seconds);
    const double step = options_.time_step;
    const Vec3f fall(options_.gravity * (step * step));
    const auto keep = static_cast<float>(1 - options_.drag);
    for (std::size_t i = 0; i < deformable_.particle_count(); ++i) {
        if (deformable_.inverse_masses[i] == 0) continue;
        Vec3f& position = deformable_.positions[i];
        Vec3f& previous = deformable_.previous_positions[i];
        const Vec3f next = position + (position - previous) * keep + fall;
        previous = position;
        position = next;
    }
    for (std::size_t i = 0; i < colliders_.size(); ++i) {
        previous_poses_[i] = colliders_[i].pose;
        colliders_[i].pose = pose_after(colliders_[i], step);
    }
}

void Simulation::relax_sticks() {
    const Stopwatch stopwatch(profile_.constraint_seconds);
    Vec3f* const positions = deformable_.positions.data();
    for (const WeightedStick& stick : weighted_sticks_) {
        Vec3f& a = positions[stick.a];
        Vec3f& b = positions[stick.b];
        const Vec3f across = b - a;
        // The smallest float keeps particles at one place from dividing by zero and is lost in all else.
        const float distance = std::sqrt(dot(across, across) + std::numeric_limits<float>::min());
        const Vec3f correction = across * (1 - stick.rest_length / distance);
        a += correction * stick.share_a;
        b -= correction * stick.share_b;
    }
}

namespace {

/// Is a particle deeper than it moved, although it began the frame outside? It then came through no surface
/// that the map knows but through the side of a layer: at a silhouette neighbouring directions differ in
/// their number of entries, and along the ray the way out may be far from the way in.
bool came_through_a_side(const Collider& collider, const Contact& contact, const Vec3f& start,
                         const Vec3f& motion) {
    return contact.inside && contact.depth > length(motion) && !contains(collider, start);
}

/// Where a contact leaves a particle. One that came through a side goes back to where it came from.
/// @param start  where the particle would be, had it moved with the collider since the last frame
Vec3f answer(const Collider& collider, const Contact& contact, const Vec3f& position, const Vec3f& start,
             const ResponseRules& rules) {
    const Vec3f motion = position - start;
    if (came_through_a_side(collider, contact, start, motion)) return start;
    return start + respond(position, motion, contact, rules);
}

} // namespace

void Simulation::collide(std::size_t collider_index) {
    const Stopwatch stopwatch(profile_.collision_seconds);
    profile_.query_count += deformable_.particle_count();
    if (is_exact(colliders_[collider_index]))
        collide_exactly(collider_index);
    else
        collide_radially(colliders_[collider_index], previous_poses_[collider_index]);
}

void Simulation::collide_radially(const Collider& collider, const RigidTransform& previous_pose) {
    const ResponseRules rules{static_cast<float>(options_.thickness), static_cast<float>(options_.friction)};
    const MaterialMotion material(previous_pose, collider.pose);
    const std::size_t particle_count = deformable_.particle_count();
    std::array<Contact, kPieceSize> contacts;
    for (std::size_t begin = 0; begin < particle_count; begin += kPieceSize) {
        const std::size_t end = std::min(begin + kPieceSize, particle_count);
        contacts_batch(collider, StridedSpan<const Vec3f>(&deformable_.positions[begin], end - begin),
                       kReachInThicknesses * rules.thickness, std::span(contacts).first(end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            const Contact& contact = contacts[i - begin];
            Vec3f& position = deformable_.positions[i];
            if (!needs_response(position, contact, rules.thickness)) continue;
            if (deformable_.inverse_masses[i] == 0) continue;
            const Vec3f start = deformable_.previous_positions[i] + material.at(position);
            position = answer(collider, contact, position, start, rules);
            ++profile_.contact_count;
        }
    }
    profile_.map_query_count += particle_count;
}

void Simulation::collide_exactly(std::size_t collider_index) {
    const ExactCollision collision = collision_with(collider_index);
    for (std::size_t i = 0; i < deformable_.particle_count(); ++i) {
        if (deformable_.inverse_masses[i] == 0) continue;
        const bool pushed = collision.relax(memories_[collider_index][i], deformable_.positions[i],
                                            deformable_.previous_positions[i], profile_);
        profile_.contact_count += pushed ? 1 : 0;
    }
}

ExactCollision Simulation::collision_with(std::size_t collider_index) const {
    return {colliders_[collider_index], previous_poses_[collider_index], options_};
}

void Simulation::judge_frame() {
    const Stopwatch stopwatch(profile_.integration_seconds);
    const double bound_sq = bound_ * bound_;
    float largest_motion_sq = 0;
    for (std::size_t i = 0; i < deformable_.particle_count(); ++i) {
        const Vec3f& position = deformable_.positions[i];
        const Vec3d from_start = Vec3d(position) - start_centre_;
        // Written so that NaN fails it.
        if (!(dot(from_start, from_start) <= bound_sq))
            throw Error(ErrorCode::Diverged, "the simulation diverged in frame " + std::to_string(frame_) +
                                                 ": particle " + std::to_string(i) +
                                                 " left all bounds; try a smaller time step or stiffness");
        const Vec3f motion = position - deformable_.previous_positions[i];
        largest_motion_sq = std::max(largest_motion_sq, dot(motion, motion));
    }
    largest_speed_ = std::sqrt(double{largest_motion_sq}) / options_.time_step;
    judge_rest();
}

void Simulation::judge_rest() {
    const auto distance_sq = static_cast<float>(options_.rest.distance * options_.rest.distance);
    const std::vector<Vec3f>& positions = deformable_.positions;
    bool all_stay = true;
    for (std::size_t i = 0; i < positions.size() && all_stay; ++i) {
        const Vec3f away = positions[i] - resting_places_[i];
        all_stay = dot(away, away) <= distance_sq;
    }
    quiet_frame_count_ = all_stay ? quiet_frame_count_ + 1 : 0;
    if (!all_stay) resting_places_ = positions;
}

std::uint64_t Simulation::state_hash() const {
    const auto hash_of = [](const std::vector<Vec3f>& points, std::uint64_t seed) {
        return XXH64(points.data(), points.size() * sizeof(Vec3f), seed);
    };
    return hash_of(deformable_.previous_positions, hash_of(deformable_.positions, 0));
}

} // namespace echinus
