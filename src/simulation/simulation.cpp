#include "collider/frame_change.hpp"
#include "simulation/contact_response.hpp"
#include "simulation/exact_collision.hpp"
#include "simulation/material_motion.hpp"
#include "simulation/solver.hpp"
#include "simulation/stopwatch.hpp"
#include "simulation/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/simulation.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
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

/// How a collider without an exact map is asked for contacts: in pieces of so many particles, those within
/// so many thicknesses.
struct Asking {
    std::size_t piece_size;
    float reach_in_thicknesses;
};

/// In pieces that stay in the first-level cache, and as far along the rays as the thickness needs.
constexpr Asking kAskDistanceMap{256, kReachInThicknesses};
/// In larger ones, since it may have to set something up for each call.
constexpr Asking kAskCustomMap{4096, 1};

Asking asking_of(const Collider& collider) {
    return std::holds_alternative<DistanceMap>(collider.map) ? kAskDistanceMap : kAskCustomMap;
}

} // namespace

Simulation::Solver::Solver(Deformable deformable_in, std::vector<Collider> colliders_in,
                           const SimulationOptions& options_in)
    : deformable((require_valid(options_in), require_valid(deformable_in), require_valid(colliders_in),
                  std::move(deformable_in))),
      colliders(std::move(colliders_in)), options(options_in),
      largest_speed(std::numeric_limits<double>::infinity()), particles_(deformable),
      sticks_(weighted_sticks(deformable, options)), goals_give_way_(sticks_.gives_way()),
      substep_seconds_(options.time_step / options.substep_count) {
    for (const Collider& collider : colliders) previous_poses_.push_back(collider.pose);
    for (const Collider& collider : colliders)
        if (is_exact(collider)) exact_.emplace_back(collider, particles_, options);
    for (const Collider& collider : colliders) {
        if (is_exact(collider)) continue;
        const std::size_t size = std::min(asking_of(collider).piece_size, deformable.particle_count());
        places_.resize(std::max(places_.size(), size));
    }
    contacts_.resize(places_.size());
    unsettled_.reserve(exact_.size() * deformable.particle_count());
    resting_places_ = deformable.positions;
    const Sphere start = box_sphere(deformable.positions);
    start_centre_ = start.centre;
    // A single particle has no extent; its bound is then in the caller's unit.
    bound_ = options.bound > 0 ? options.bound : 1e4 * (start.radius > 0 ? 2 * start.radius : 1);
}

void Simulation::Solver::step() {
    begin_frame();
    for (std::uint32_t substep = 0; substep < options.substep_count; ++substep) {
        integrate(substep == 0 ? 1 - options.drag : 1);
        move_colliders();
        restore_goal_lengths();
        for (std::uint32_t iteration = 0; iteration < options.iteration_count; ++iteration) {
            relax_sticks();
            collide();
        }
    }
    keep_free();
    publish();
    ++frame;
    judge_frame();
}

void Simulation::Solver::begin_frame() {
    const Stopwatch stopwatch(profile.integration_seconds);
    particles_.frame_start = particles_.positions;
    std::size_t exact = 0;
    for (const Collider& collider : colliders)
        if (is_exact(collider)) exact_[exact++].begin_frame(collider);
}

namespace {

/// x' = x + (1 - drag) (x - x_previous) + a dt^2 (Jakobsen 2001, section 2), of one coordinate. Plain arrays
/// that do not overlap and no branch, for the compiler's vectors.
/// @param mobility  1, or 0 of a particle that is pinned
void integrate(float* __restrict positions, float* __restrict previous, const float* __restrict mobility,
               std::size_t count, float keep, float fall) {
    for (std::size_t i = 0; i < count; ++i) {
        const float position = positions[i];
        const float way = (position - previous[i]) * keep * mobility[i];
        previous[i] = position;
        positions[i] = position + way + fall * mobility[i];
    }
}

} // namespace

/// @param share_kept  of the velocity
void Simulation::Solver::integrate(double share_kept) {
    const Stopwatch stopwatch(profile.integration_seconds);
    const Vec3f fall(options.gravity * (substep_seconds_ * substep_seconds_));
    const auto keep = static_cast<float>(share_kept);
    PointArrays& now = particles_.positions;
    PointArrays& before = particles_.previous;
    const float* mobility = particles_.mobility.data();
    echinus::integrate(now.x.data(), before.x.data(), mobility, particles_.count(), keep, fall.x);
    echinus::integrate(now.y.data(), before.y.data(), mobility, particles_.count(), keep, fall.y);
    echinus::integrate(now.z.data(), before.z.data(), mobility, particles_.count(), keep, fall.z);
}

void Simulation::Solver::move_colliders() {
    const Stopwatch stopwatch(profile.collision_seconds);
    std::size_t exact = 0;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        previous_poses_[i] = colliders[i].pose;
        colliders[i].pose = pose_after(colliders[i], substep_seconds_);
        if (is_exact(colliders[i])) exact_[exact++].begin_substep(colliders[i], previous_poses_[i], options);
    }
}

/// Multipliers begin at 0 in each substep (Macklin et al. 2016, algorithm 1).
void Simulation::Solver::restore_goal_lengths() {
    const Stopwatch stopwatch(profile.constraint_seconds);
    if (goals_give_way_)
        std::copy(sticks_.rest_lengths.begin(), sticks_.rest_lengths.end(), sticks_.goal_lengths.begin());
}

void Simulation::Solver::relax_sticks() {
    const Stopwatch stopwatch(profile.constraint_seconds);
    relax(sticks_, particles_.positions);
}

namespace {

/// Is a particle deeper than it moved, although it began the frame outside? It then came through no surface
/// that the map knows. With a distance map it came through the side of a layer: at a silhouette neighbouring
/// directions differ in their number of entries, and along the ray the way out may be far from the way in.
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

void Simulation::Solver::collide() {
    const Stopwatch stopwatch(profile.collision_seconds);
    std::size_t exact = 0;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        profile.query_count += particles_.count();
        if (is_exact(colliders[i]))
            exact_[exact++].relax(particles_, profile);
        else
            collide_by_contacts(colliders[i], previous_poses_[i]);
    }
}

void Simulation::Solver::collide_by_contacts(const Collider& collider, const RigidTransform& previous_pose) {
    const ResponseRules rules{static_cast<float>(options.thickness), static_cast<float>(options.friction)};
    const MaterialMotion material(previous_pose, collider.pose);
    const Asking asking = asking_of(collider);
    const float reach = asking.reach_in_thicknesses * rules.thickness;
    const std::size_t particle_count = deformable.particle_count();
    for (std::size_t begin = 0; begin < particle_count; begin += asking.piece_size) {
        const std::size_t end = std::min(begin + asking.piece_size, particle_count);
        for (std::size_t i = begin; i < end; ++i) places_[i - begin] = particles_.positions[i];
        contacts_batch(collider, std::span<const Vec3f>(places_).first(end - begin), reach,
                       std::span(contacts_).first(end - begin));
        for (std::size_t i = begin; i < end; ++i) {
            const Contact& contact = contacts_[i - begin];
            const Vec3f& position = places_[i - begin];
            if (!needs_response(position, contact, rules.thickness)) continue;
            if (particles_.pinned(i)) continue;
            const Vec3f start = particles_.previous[i] + material.at(position);
            particles_.positions.set(i, answer(collider, contact, position, start, rules));
            ++profile.contact_count;
        }
    }
    profile.map_query_count += particle_count;
}

void Simulation::Solver::publish() {
    const Stopwatch stopwatch(profile.integration_seconds);
    particles_.positions.store(deformable.positions);
    particles_.previous.store(deformable.previous_positions);
}

void Simulation::Solver::judge_frame() {
    const Stopwatch stopwatch(profile.integration_seconds);
    const double bound_sq = bound_ * bound_;
    float largest_motion_sq = 0;
    for (std::size_t i = 0; i < deformable.particle_count(); ++i) {
        const Vec3f& position = deformable.positions[i];
        const Vec3d from_start = Vec3d(position) - start_centre_;
        // Written so that NaN fails it.
        if (!(dot(from_start, from_start) <= bound_sq))
            throw Error(ErrorCode::Diverged, "the simulation diverged in frame " + std::to_string(frame) +
                                                 ": particle " + std::to_string(i) +
                                                 " left all bounds; try a smaller time step or stiffness");
        const Vec3f motion = position - deformable.previous_positions[i];
        largest_motion_sq = std::max(largest_motion_sq, dot(motion, motion));
    }
    largest_speed = std::sqrt(double{largest_motion_sq}) / substep_seconds_;
    judge_rest();
}

void Simulation::Solver::judge_rest() {
    const auto distance_sq = static_cast<float>(options.rest.distance * options.rest.distance);
    const std::vector<Vec3f>& positions = deformable.positions;
    bool all_stay = true;
    for (std::size_t i = 0; i < positions.size() && all_stay; ++i) {
        const Vec3f away = positions[i] - resting_places_[i];
        all_stay = dot(away, away) <= distance_sq;
    }
    quiet_frame_count_ = all_stay ? quiet_frame_count_ + 1 : 0;
    if (!all_stay) resting_places_ = positions;
}

Simulation::Simulation(Deformable deformable, std::vector<Collider> colliders,
                       const SimulationOptions& options)
    : solver_(std::make_unique<Solver>(std::move(deformable), std::move(colliders), options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(const Simulation& other) : solver_(std::make_unique<Solver>(*other.solver_)) {}
Simulation& Simulation::operator=(const Simulation& other) {
    if (this != &other) solver_ = std::make_unique<Solver>(*other.solver_);
    return *this;
}
Simulation::Simulation(Simulation&& other) noexcept = default;
Simulation& Simulation::operator=(Simulation&& other) noexcept = default;

void Simulation::step() {
    solver_->step();
}

const Deformable& Simulation::deformable() const {
    return solver_->deformable;
}
const std::vector<Collider>& Simulation::colliders() const {
    return solver_->colliders;
}
const SimulationOptions& Simulation::options() const {
    return solver_->options;
}
std::uint32_t Simulation::frame() const {
    return solver_->frame;
}
double Simulation::largest_speed() const {
    return solver_->largest_speed;
}
bool Simulation::at_rest() const {
    return solver_->at_rest();
}
const SimulationProfile& Simulation::profile() const {
    return solver_->profile;
}

void Simulation::set_collider_velocity(std::size_t collider_index, const Vec3d& linear,
                                       const Vec3d& angular) {
    solver_->colliders[collider_index].linear_velocity = linear;
    solver_->colliders[collider_index].angular_velocity = angular;
}

void Simulation::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    solver_->set_particle_velocity(particle, velocity);
}

void Simulation::blow(const Vec3d& wind, double rate) {
    solver_->blow(wind, rate);
}

std::uint64_t Simulation::state_hash() const {
    const auto hash_of = [](const std::vector<Vec3f>& points, std::uint64_t seed) {
        return XXH64(points.data(), points.size() * sizeof(Vec3f), seed);
    };
    return hash_of(deformable().previous_positions, hash_of(deformable().positions, 0));
}

} // namespace echinus
