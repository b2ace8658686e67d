#include "files/text.hpp"
#include "geometry/precondition.hpp"
#include "simulation/jakobsen/collisions.hpp"
#include "simulation/start/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/particle_collision.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// The options of the solver that has this kind of collision.
SimulationOptions simulation_options(double thickness, const ParticleCollisionOptions& options) {
    SimulationOptions all;
    all.solver = JakobsenOptions{};
    all.thickness = thickness;
    all.friction = options.friction;
    all.allow_open_colliders = options.allow_open_colliders;
    all.thread_count = options.thread_count;
    return all;
}

/// False for NaN.
bool is_sane(const Vec3f& p) {
    constexpr float kFarthest = ParticleCollision::kFarthest;
    return std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest && std::fabs(p.z) <= kFarthest;
}

[[noreturn]] void fail(const std::string& sentence) {
    throw Error(ErrorCode::InvalidOptions, sentence);
}

/// Texts are composed only for an error, since they need memory.
void require_valid(const SolverStep& step, double seconds) {
    if (!(seconds > 0 && std::isfinite(seconds)))
        fail("a step takes " + number_text(seconds) + " seconds; it must be a finite time above 0");
    const std::size_t count = step.positions.size();
    const auto require_size = [&](const char* name, std::size_t size) {
        if (size != count)
            fail("a step has " + std::to_string(count) + " positions and " + std::to_string(size) + " " +
                 name + "; it needs as many");
    };
    require_size("previous positions", step.previous_positions.size());
    if (!step.velocities.empty()) require_size("velocities", step.velocities.size());
    if (!step.inverse_masses.empty()) require_size("inverse masses", step.inverse_masses.size());
    for (std::size_t i = 0; i < step.inverse_masses.size(); ++i)
        if (!(step.inverse_masses[i] >= 0 && std::isfinite(step.inverse_masses[i])))
            fail("particle " + std::to_string(i) + " has an inverse mass that is negative or not finite");
}

} // namespace

struct ParticleCollision::State {
    State(std::vector<Collider> colliders_in, const SimulationOptions& options_in)
        : options(options_in), colliders(std::move(colliders_in)), next(colliders.size()),
          frictions(colliders.size(), options.friction), workers(options.thread_count) {}

    void begin_step(const SolverStep& step);
    void load_start(const SolverStep& step);
    void load_ends(const SolverStep& step);
    void move_colliders();
    void write_back(const SolverStep& step, double seconds);
    Vec3f corrected_velocity(std::size_t i, const SolverStep& step, double seconds) const;

    SimulationOptions options;
    std::vector<Collider> colliders;
    std::vector<std::optional<RigidTransform>> next; ///< [collider] the pose to which the next step leads it
    std::vector<double> frictions;                   ///< [collider]
    Workers workers;
    Particles particles;
    std::optional<Collisions> collisions; ///< none before the first step, and if all particles start again
    std::vector<std::uint32_t> restarted; ///< in the step that begins
    std::vector<std::uint32_t> corrected; ///< with capacity for all
    SimulationProfile profile;
};

void ParticleCollision::State::begin_step(const SolverStep& step) {
    const std::size_t count = step.positions.size();
    if (count != particles.count()) {
        collisions.reset();
        particles = {};
        particles.mobility.resize(count);
        for (PointArrays* points : {&particles.positions, &particles.previous, &particles.frame_start})
            points->resize(count);
        restarted.reserve(count);
        corrected.reserve(count);
    }
    load_start(step);
    if (collisions) {
        collisions->restart(restarted, particles);
    } else {
        particles.positions = particles.frame_start;
        collisions.emplace(Deformable{}, colliders, particles, options);
    }
    load_ends(step);
}

/// Loads the starts of the step, and finds the particles that do not begin where the last step ended.
void ParticleCollision::State::load_start(const SolverStep& step) {
    restarted.clear();
    for (std::size_t i = 0; i < step.positions.size(); ++i) {
        const bool moves = is_sane(step.positions[i]);
        const bool is_pinned = !step.inverse_masses.empty() && step.inverse_masses[i] == 0;
        const float mobility = moves && !is_pinned ? 1 : 0;
        Vec3f start = step.previous_positions[i];
        if (!is_sane(start)) start = moves ? step.positions[i] : Vec3f{};
        if (start != particles.positions[i] || mobility != particles.mobility[i])
            restarted.push_back(static_cast<std::uint32_t>(i));
        particles.mobility[i] = mobility;
        particles.frame_start.set(i, start);
    }
}

void ParticleCollision::State::load_ends(const SolverStep& step) {
    particles.previous = particles.frame_start;
    for (std::size_t i = 0; i < step.positions.size(); ++i)
        particles.positions.set(i, is_sane(step.positions[i]) ? step.positions[i] : particles.frame_start[i]);
}

void ParticleCollision::State::move_colliders() {
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const RigidTransform before = colliders[i].pose;
        if (next[i]) colliders[i].pose = *std::exchange(next[i], std::nullopt);
        collisions->set_friction(i, frictions[i]);
        collisions->begin_frame(i, colliders[i], before);
    }
}

void ParticleCollision::State::write_back(const SolverStep& step, double seconds) {
    corrected.clear();
    for (std::size_t i = 0; i < step.positions.size(); ++i) {
        if (particles.pinned(i) || particles.positions[i] == step.positions[i]) continue;
        corrected.push_back(static_cast<std::uint32_t>(i));
        if (!step.velocities.empty()) step.velocities[i] = corrected_velocity(i, step, seconds);
        step.positions[i] = particles.positions[i];
    }
}

/// The step still contains the positions that the solver chose.
Vec3f ParticleCollision::State::corrected_velocity(std::size_t i, const SolverStep& step,
                                                   double seconds) const {
    const Vec3d sent = Vec3d(step.positions[i]) - Vec3d(particles.frame_start[i]);
    const Vec3d motion = Vec3d(step.velocities[i]) * seconds + Vec3d(particles.step(i)) - sent;
    return Vec3f(collisions->without_approach(i, particles, motion) * (1 / seconds));
}

ParticleCollision::ParticleCollision(std::vector<Collider> colliders, double thickness,
                                     const ParticleCollisionOptions& options) {
    require_within("thickness", thickness, 0, kMostThickness);
    require_ranges(options);
    const SimulationOptions all = simulation_options(thickness, options);
    echinus::require_valid(colliders, all);
    for (Collider& collider : colliders) collider.pose.rotation = collider.pose.rotation.normalised();
    state_ = std::make_unique<State>(std::move(colliders), all);
}
ParticleCollision::~ParticleCollision() = default;
ParticleCollision::ParticleCollision(const ParticleCollision& other)
    : state_(std::make_unique<State>(*other.state_)) {}
ParticleCollision& ParticleCollision::operator=(const ParticleCollision& other) {
    if (this != &other) state_ = std::make_unique<State>(*other.state_);
    return *this;
}
ParticleCollision::ParticleCollision(ParticleCollision&& other) noexcept = default;
ParticleCollision& ParticleCollision::operator=(ParticleCollision&& other) noexcept = default;

void ParticleCollision::set_collider_pose(std::size_t collider_index, const RigidTransform& pose) {
    if (!is_in_range(collider_index, state_->colliders.size(), "collider")) return;
    echinus::require_valid(pose, name_of(state_->colliders[collider_index], collider_index));
    state_->next[collider_index] = {pose.rotation.normalised(), pose.translation};
}

void ParticleCollision::place_collider(std::size_t collider_index, const RigidTransform& pose) {
    if (!is_in_range(collider_index, state_->colliders.size(), "collider")) return;
    set_collider_pose(collider_index, pose);
    state_->colliders[collider_index].pose = *std::exchange(state_->next[collider_index], std::nullopt);
    state_->collisions.reset();
}

void ParticleCollision::set_collider_friction(std::size_t collider_index, double friction) {
    if (!is_in_range(collider_index, state_->colliders.size(), "collider")) return;
    require_ranges(ParticleCollisionOptions{.friction = friction});
    state_->frictions[collider_index] = friction;
}

std::span<const std::uint32_t> ParticleCollision::correct(const SolverStep& step, double seconds) {
    require_valid(step, seconds);
    const Workers::Session session(state_->workers);
    state_->begin_step(step);
    state_->move_colliders();
    state_->collisions->leave_out_away(state_->particles);
    state_->collisions->relax(state_->particles, state_->profile, state_->workers);
    state_->collisions->keep_free(state_->particles, state_->profile);
    state_->write_back(step, seconds);
    return state_->corrected;
}

const std::vector<Collider>& ParticleCollision::colliders() const {
    return state_->colliders;
}

std::uint64_t ParticleCollision::lost_count() const {
    return state_->profile.lost_count;
}

} // namespace echinus
