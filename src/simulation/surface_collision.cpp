#include "files/text.hpp"
#include "simulation/jakobsen/contact_response.hpp"
#include "simulation/start/validation.hpp"

#include <echinus/error.hpp>
#include <echinus/particle_collision.hpp>
#include <echinus/simulation.hpp>
#include <echinus/surface_collision.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace echinus {

namespace {

/// As a share of the thickness. A step of the simulation converges only to a tolerance, so a smaller
/// displacement is not a correction.
constexpr float kLeastCorrection = 1e-3F;

/// The distance from the surface, in thicknesses, within which a particle has hit it.
constexpr float kReachOfImpact = 2;

/// The options of a simulation in which particles only collide: faces have next to no stiffness, and the unit
/// of time is a step of the solver, however long that is.
SimulationOptions simulation_options(double thickness, const SurfaceCollisionOptions& options) {
    SimulationOptions all;
    all.time_step = 1;
    all.gravity = {};
    all.solver = NewtonOptions{
        .material = {.stretch_stiffness = 1e-6, .shear_stiffness = 0, .bending_stiffness = 0, .damping = 0},
        .air_drag = 0,
        .collision = options.self_collision ? CollisionMode::SurfacesAndSelf : CollisionMode::Surfaces,
        .self_thickness = options.self_thickness,
        .untangle = options.untangle};
    all.bound = 1e30; // the solver may send its particles anywhere
    all.thickness = thickness;
    all.friction = options.friction;
    all.thread_count = options.thread_count;
    return all;
}

Deformable deformable_of(std::vector<Vec3f> positions, std::vector<Triangle> faces) {
    const std::size_t count = positions.size();
    return {.positions = positions,
            .inverse_masses = std::vector<float>(count, 1),
            .constraints = {},
            .faces = std::move(faces)};
}

std::vector<Collider> at_rest(std::vector<Collider> colliders) {
    for (Collider& collider : colliders) collider.linear_velocity = collider.angular_velocity = {};
    return colliders;
}

} // namespace

struct SurfaceCollision::State {
    explicit State(Simulation simulation_in)
        : simulation(std::move(simulation_in)), particles(simulation.positions().size()) {
        corrected.reserve(particles.size());
    }

    void send(std::span<const Vec3f> positions);
    void write_back(std::span<Vec3f> positions, std::span<Vec3f> velocities, double seconds);
    Vec3d without_approach(const Vec3f& position, Vec3d motion) const;

    Simulation simulation;
    struct Particle {
        Vec3f from;                 ///< its position at the beginning of the step
        Vec3d sent;                 ///< its motion in this step without contact
        bool has_exploded = false;  ///< in this step
        bool was_corrected = false; ///< in the step before
    };
    std::vector<Particle> particles;
    std::vector<std::uint32_t> corrected;
};

/// Gives particles the velocities that lead to the positions that the solver chose.
void SurfaceCollision::State::send(std::span<const Vec3f> positions) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const Vec3d motion = Vec3d(positions[i]) - Vec3d(simulation.positions()[i]);
        Particle& particle = particles[i];
        particle.from = simulation.positions()[i];
        constexpr double kFarthest{ParticleCollision::kFarthest};
        particle.has_exploded = !(dot(motion, motion) <= kFarthest * kFarthest); // true for NaN, too
        particle.sent = particle.has_exploded ? Vec3d{} : motion;
        simulation.set_particle_velocity(i, particle.sent);
    }
}

/// The motion that a particle keeps after an impact. The motion of the step still contains its approach to
/// the surface.
Vec3d SurfaceCollision::State::without_approach(const Vec3f& position, Vec3d motion) const {
    const SimulationOptions& options = simulation.options();
    const float reach = kReachOfImpact * static_cast<float>(options.thickness.value());
    for (const Collider& collider : simulation.colliders()) {
        const Contact nearest = contact(collider, position, reach);
        if (!nearest.found()) continue;
        const Vec3d material = velocity_at(collider, Vec3d(position)); // displacement in one step
        motion = material +
                 stopped_motion(motion - material, nearest.normal, static_cast<float>(options.friction));
    }
    return motion;
}

void SurfaceCollision::State::write_back(std::span<Vec3f> positions, std::span<Vec3f> velocities,
                                         double seconds) {
    const Deformable& now = simulation.deformable();
    const float least = kLeastCorrection * static_cast<float>(simulation.options().thickness.value());
    corrected.clear();
    for (std::uint32_t i = 0; i < particles.size(); ++i) {
        Particle& particle = particles[i];
        const bool is_corrected = !particle.has_exploded && length(now.positions[i] - positions[i]) > least;
        const bool is_impact = is_corrected && !particle.was_corrected;
        particle.was_corrected = is_corrected;
        if (!is_corrected) continue;
        corrected.push_back(i);
        positions[i] = now.positions[i];
        if (velocities.empty()) continue;
        const Vec3d change = Vec3d(now.positions[i]) - Vec3d(particle.from) - particle.sent;
        Vec3d motion = Vec3d(velocities[i]) * seconds + change;
        if (is_impact) motion = without_approach(positions[i], motion);
        velocities[i] = Vec3f(motion * (1 / seconds));
    }
}

SurfaceCollision::SurfaceCollision(std::vector<Vec3f> positions, std::vector<Triangle> faces,
                                   std::vector<Collider> colliders, double thickness,
                                   const SurfaceCollisionOptions& options) {
    require_within("thickness", thickness, 0, kMostThickness);
    require_ranges(options);
    require_option(!faces.empty(), "surface collision needs faces; pass those of the deformable");
    state_ = std::make_unique<State>(Simulation(deformable_of(std::move(positions), std::move(faces)),
                                                at_rest(std::move(colliders)),
                                                simulation_options(thickness, options)));
}
SurfaceCollision::~SurfaceCollision() = default;
SurfaceCollision::SurfaceCollision(const SurfaceCollision& other)
    : state_(std::make_unique<State>(*other.state_)) {}
SurfaceCollision& SurfaceCollision::operator=(const SurfaceCollision& other) {
    if (this != &other) state_ = std::make_unique<State>(*other.state_);
    return *this;
}
SurfaceCollision::SurfaceCollision(SurfaceCollision&& other) noexcept = default;
SurfaceCollision& SurfaceCollision::operator=(SurfaceCollision&& other) noexcept = default;

void SurfaceCollision::set_collider_pose(std::size_t collider_index, const RigidTransform& pose) {
    state_->simulation.set_collider_pose(collider_index, pose);
}

std::span<const std::uint32_t> SurfaceCollision::correct(std::span<Vec3f> positions,
                                                         std::span<Vec3f> velocities, double seconds) {
    const std::size_t count = state_->particles.size();
    require_option(seconds > 0 && std::isfinite(seconds),
                   "a step takes " + number_text(seconds) + " seconds; it must be a finite time above 0");
    require_option(positions.size() == count && (velocities.empty() || velocities.size() == count),
                   "a step was given " + std::to_string(positions.size()) + " positions and " +
                       std::to_string(velocities.size()) + " velocities; it needs " + std::to_string(count) +
                       " positions, and as many velocities or none");
    state_->send(positions);
    state_->simulation.step();
    state_->write_back(positions, velocities, seconds);
    return state_->corrected;
}

const std::vector<Vec3f>& SurfaceCollision::positions() const {
    return state_->simulation.deformable().positions;
}
const std::vector<Collider>& SurfaceCollision::colliders() const {
    return state_->simulation.colliders();
}
std::uint64_t SurfaceCollision::unresolved_count() const {
    return state_->simulation.profile().unresolved_count;
}

} // namespace echinus
