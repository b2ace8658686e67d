#include "geometry/precondition.hpp"
#include "simulation/solver.hpp"

#include <echinus/simulation.hpp>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <utility>
#include <variant>
#include <vector>

namespace echinus {

SolverChoice::SolverChoice(const SimulationOptions& options) : kind(options.kind()) {
    if (const auto* held = std::get_if<NewtonOptions>(&options.solver)) newton = *held;
    if (const auto* held = std::get_if<JakobsenOptions>(&options.solver)) {
        jakobsen = *held;
        newton.collision = CollisionMode::Particles;
    }
}

std::variant<NewtonOptions, JakobsenOptions> SolverChoice::chosen() const {
    if (kind == SolverKind::Newton) return newton;
    return jakobsen;
}

Simulation::Simulation(Deformable deformable, std::vector<Collider> colliders,
                       const SimulationOptions& options)
    : solver_(make_solver(std::move(deformable), std::move(colliders), options)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(const Simulation& other) : solver_(other.solver_->copy()) {}
Simulation& Simulation::operator=(const Simulation& other) {
    if (this != &other) solver_ = other.solver_->copy();
    return *this;
}
Simulation::Simulation(Simulation&& other) noexcept = default;
Simulation& Simulation::operator=(Simulation&& other) noexcept = default;

void Simulation::step() {
    const SimulationOptions& options = solver_->options;
    solver_->carry_out_teleports();
    if (options.wind_rate > 0 && !solver_->has_blown) blow(options.wind, options.wind_rate);
    solver_->step();
    solver_->has_blown = false;
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
Residual Simulation::residual() const {
    return solver_->residual();
}
bool Simulation::at_rest() const {
    return solver_->at_rest();
}
const SimulationProfile& Simulation::profile() const {
    return solver_->profile;
}

void Simulation::set_collider_velocity(std::size_t collider_index, const Vec3d& linear,
                                       const Vec3d& angular) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->motions.keep_velocity(collider_index);
    solver_->colliders[collider_index].linear_velocity = linear;
    solver_->colliders[collider_index].angular_velocity = angular;
}

void Simulation::set_collider_pose(std::size_t collider_index, const RigidTransform& pose) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->motions.lead_to(collider_index, solver_->name_of_collider(collider_index), pose);
}

void Simulation::set_collider_keyframes(std::size_t collider_index, std::vector<PoseKey> keys) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->motions.follow(collider_index, solver_->name_of_collider(collider_index), std::move(keys));
}

void Simulation::set_collider_free(std::size_t collider_index, double mass) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->set_free(collider_index, mass);
}

void Simulation::teleport(const Teleport& teleport) {
    solver_->teleport(teleport);
}

void Simulation::set_collider_vertices(std::size_t collider_index, std::span<const Vec3f> vertices_local) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->lead_vertices(collider_index, vertices_local);
}

void Simulation::set_collider_cache(std::size_t collider_index, VertexCache cache) {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return;
    solver_->follow_cache(collider_index, std::move(cache));
}

Load Simulation::load_on(std::size_t collider_index) const {
    if (!is_in_range(collider_index, colliders().size(), "collider")) return {};
    return solver_->load_on(collider_index);
}

void Simulation::record_contacts(bool is_on) {
    solver_->record_contacts(is_on);
}

std::span<const ContactPoint> Simulation::contact_points() const {
    return solver_->contact_points();
}

void Simulation::set_particle_velocity(std::size_t particle, const Vec3d& velocity) {
    if (!is_in_range(particle, deformable().particle_count(), "particle")) return;
    solver_->set_particle_velocity(particle, velocity);
}

void Simulation::blow(const Vec3d& wind, double rate) {
    solver_->blow(wind, rate);
    solver_->has_blown = true;
}

std::uint64_t Simulation::state_hash() const {
    const auto hash_of = [](const std::vector<Vec3f>& points, std::uint64_t seed) {
        return XXH64(points.data(), points.size() * sizeof(Vec3f), seed);
    };
    return hash_of(deformable().velocities, hash_of(deformable().positions, 0));
}

} // namespace echinus
