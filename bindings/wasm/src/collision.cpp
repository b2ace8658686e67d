// Collision for particles that another solver moves: a simulation of which nothing holds together, whose
// particles are sent where that solver has put them.

#include "interface.hpp"

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace echinus::wasm {

namespace {

/// The unit of time of the simulation is one step of the other solver, however long it is.
constexpr double kStep = 1;

struct Collision {
    std::unique_ptr<echinus_simulation> owned;
    Simulation& simulation = owned->value;
    std::vector<Vec3f> positions = simulation.deformable().positions; ///< by the other solver, then corrected
    std::vector<Vec3f> velocities = std::vector<Vec3f>(positions.size()); ///< of those that were corrected
    std::vector<Vec3f> sent = velocities; ///< where they come to without contact
    std::vector<std::uint8_t> was_corrected =
        std::vector<std::uint8_t>(positions.size()); ///< in the step before
    std::vector<std::uint32_t> corrected =
        std::vector<std::uint32_t>(positions.size()); ///< [corrected_count] ascending
    std::uint32_t corrected_count = 0;
};

/// Farther than this in a step, units, a particle has exploded.
constexpr double kFarthest = 1e12;

/// Moves a particle by its other solver's step. It does not follow one that has exploded.
/// @return where the simulation's integration puts it without contact
Vec3f send(Simulation& simulation, std::size_t particle, const Vec3f& from, const Vec3f& to) {
    Vec3d way = Vec3d(to) - Vec3d(from);
    if (!(dot(way, way) <= kFarthest * kFarthest)) way = {}; // NaN, too
    simulation.set_particle_velocity(particle, way * (1 / kStep));
    return from + (from - simulation.deformable().previous_positions[particle]);
}

/// The rest of a particle's motion in a step after an impact: nothing into the surfaces that it touches.
/// The motion of the step itself still has its way to the surface in it.
Vec3d without_approach(const Simulation& simulation, const Vec3f& position, Vec3d motion) {
    const float reach = 2 * static_cast<float>(*simulation.options().thickness);
    for (const Collider& collider : simulation.colliders()) {
        const Contact nearest = contact(collider, position, reach);
        if (!nearest.found()) continue;
        const Vec3d surface = velocity_at(collider, Vec3d(position)) * kStep;
        const double along = dot(motion - surface, Vec3d(nearest.normal));
        if (along < 0) motion -= Vec3d(nearest.normal) * along;
    }
    return motion;
}

/// A correction is longer than this. Particles are sent to the bit by the jakobsen solver; under the newton
/// solver, where surfaces collide, a step converges to a tolerance.
float least_correction(const SimulationOptions& options) {
    constexpr float kInThicknesses = 1e-3F;
    return options.surface_collision ? kInThicknesses * static_cast<float>(*options.thickness) : 0;
}

void note_corrections(Collision& collision, double seconds) {
    const Deformable& now = collision.simulation.deformable();
    const float least = least_correction(collision.simulation.options());
    collision.corrected_count = 0;
    for (std::uint32_t i = 0; i < collision.sent.size(); ++i) {
        const bool is_corrected = length(now.positions[i] - collision.sent[i]) > least;
        const bool is_impact = is_corrected && collision.was_corrected[i] == 0;
        collision.was_corrected[i] = is_corrected ? 1 : 0;
        if (!is_corrected) continue;
        collision.corrected[collision.corrected_count++] = i;
        collision.positions[i] = now.positions[i];
        Vec3d motion = Vec3d(now.positions[i]) - Vec3d(now.previous_positions[i]);
        if (is_impact) motion = without_approach(collision.simulation, now.positions[i], motion);
        collision.velocities[i] = Vec3f(motion * (1 / seconds));
    }
}

void correct(Collision& collision, double seconds) {
    const std::vector<Vec3f>& before = collision.simulation.deformable().positions;
    for (std::size_t i = 0; i < before.size(); ++i)
        collision.sent[i] = send(collision.simulation, i, before[i], collision.positions[i]);
    collision.simulation.step();
    note_corrections(collision, seconds);
}

} // namespace

/// @param simulation  without a material, with a time step of kStep; taken over, also by a call that fails
ECHINUS_EXPORT(wasm_collision_make)
echinus_status wasm_collision_make(echinus_simulation* simulation, Collision** collision) {
    std::unique_ptr<echinus_simulation> owned(simulation);
    return make(__func__, collision, [&] { return Collision{std::move(owned)}; });
}
ECHINUS_EXPORT(wasm_collision_delete) void wasm_collision_delete(Collision* collision) {
    delete collision;
}

ECHINUS_EXPORT(wasm_collision_correct)
echinus_status wasm_collision_correct(Collision* collision, double seconds) {
    return guarded(__func__, [&] { correct(*collision, seconds); });
}

ECHINUS_EXPORT(wasm_collision_simulation)
echinus_simulation* wasm_collision_simulation(const Collision* collision) {
    return collision->owned.get();
}
ECHINUS_EXPORT(wasm_collision_positions) const Vec3f* wasm_collision_positions(const Collision* collision) {
    return collision->positions.data();
}
ECHINUS_EXPORT(wasm_collision_velocities) const Vec3f* wasm_collision_velocities(const Collision* collision) {
    return collision->velocities.data();
}
ECHINUS_EXPORT(wasm_collision_corrected)
const std::uint32_t* wasm_collision_corrected(const Collision* collision) {
    return collision->corrected.data();
}
ECHINUS_EXPORT(wasm_collision_corrected_count)
std::uint32_t wasm_collision_corrected_count(const Collision* collision) {
    return collision->corrected_count;
}

/// The function that gives back what memalign() took.
ECHINUS_EXPORT(wasm_free) void (*wasm_free())(void*) {
    return std::free;
}

} // namespace echinus::wasm
