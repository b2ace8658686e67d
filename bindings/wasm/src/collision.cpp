// Collision for particles that another solver moves: a simulation without sticks, whose particles are sent
// where that solver has put them.

#include "interface.hpp"

#include <echinus/any_map.hpp>
#include <echinus/simulation.hpp>

#include <cstddef>
#include <vector>

namespace echinus::wasm {

namespace {

/// The unit of time of the simulation is one step of the other solver, however long it is.
constexpr double kStep = 1;

/// Of the simulation. Surfaces need more relaxations than particles, each of which has one nearest point.
constexpr std::uint32_t kIterations = 1, kSurfaceIterations = 4;

struct Collision {
    Simulation simulation;
    std::vector<Vec3f> positions;            ///< [particle_count] by the other solver, then corrected
    std::vector<Vec3f> velocities;           ///< [particle_count] of those that were corrected
    std::vector<Vec3f> sent;                 ///< [particle_count] where they come to without contact
    std::vector<std::uint8_t> was_corrected; ///< [particle_count] in the step before
    std::vector<std::uint32_t> corrected{};

    explicit Collision(Simulation simulation_in)
        : simulation(std::move(simulation_in)),
          positions(simulation.positions().begin(), simulation.positions().end()),
          velocities(positions.size()), sent(positions.size()), was_corrected(positions.size()) {
        corrected.reserve(positions.size());
    }
};

Vec3d vector_of(const json& numbers) {
    return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

RigidTransform pose_of(const json& description) {
    const json& r = description.at("rotation");
    return {{r.at(0), r.at(1), r.at(2), r.at(3)}, vector_of(description.at("position"))};
}

std::vector<Collider> colliders_of(const json& descriptions, std::span<const AnyMap* const> maps) {
    std::vector<Collider> colliders;
    for (std::size_t i = 0; i < maps.size(); ++i) {
        Collider collider{.map = *maps[i], .pose = pose_of(descriptions.at(i))};
        collider.scale = vector_of(descriptions.at(i).at("scale"));
        colliders.push_back(std::move(collider));
    }
    return colliders;
}

SimulationOptions options_of(const json& description) {
    SimulationOptions options;
    options.time_step = kStep;
    options.gravity = {};
    options.drag = 0;
    options.bound = 1e30; // where the other solver sends its particles is not ours to judge
    options.thickness = description.at("thickness").get<double>();
    options.friction = description.at("friction");
    options.surface_collision = description.at("surfaces");
    options.self_collision = description.at("selfCollision");
    options.allow_open_colliders = description.at("allowOpenColliders");
    options.untangle = description.at("untangle");
    options.iteration_count = options.surface_collision ? kSurfaceIterations : kIterations;
    return options;
}

Deformable deformable_of(std::span<const Vec3f> positions, std::span<const Triangle> faces) {
    Deformable particles;
    particles.positions.assign(positions.begin(), positions.end());
    particles.previous_positions = particles.positions;
    particles.inverse_masses.assign(positions.size(), 1.0F);
    particles.faces.assign(faces.begin(), faces.end());
    return particles;
}

/// Farther than this in a step, units, a particle has exploded.
constexpr double kFarthest = 1e12;

/// Moves a particle by its other solver's step. It does not follow one that has exploded.
/// @return where the simulation's integration puts it, to the bit
Vec3f send(Simulation& simulation, std::size_t particle, const Vec3f& from, const Vec3f& to) {
    Vec3d way = Vec3d(to) - Vec3d(from);
    if (!(dot(way, way) <= kFarthest * kFarthest)) way = {}; // NaN, too
    simulation.set_particle_velocity(particle, way * (1 / kStep));
    return from + (from - simulation.deformable().previous_positions[particle]);
}

/// What is left of a particle's motion in a step after an impact: nothing into the surfaces that it touches.
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

void note_corrections(Collision& collision, double seconds) {
    const Deformable& now = collision.simulation.deformable();
    collision.corrected.clear();
    for (std::uint32_t i = 0; i < collision.sent.size(); ++i) {
        const bool is_corrected = now.positions[i] != collision.sent[i];
        const bool is_impact = is_corrected && collision.was_corrected[i] == 0;
        collision.was_corrected[i] = is_corrected ? 1 : 0;
        if (!is_corrected) continue;
        collision.corrected.push_back(i);
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

/// @param positions    [particle_count]
/// @param faces        [face_count] for surfaces, else none
/// @param maps         [map_count] one for each collider
/// @param description  JSON that js/collision.mjs has checked
ECHINUS_EXPORT(collision_make)
Collision* collision_make(const Vec3f* positions, std::uint32_t particle_count, const Triangle* faces,
                          std::uint32_t face_count, const AnyMap* const* maps, std::uint32_t map_count,
                          const char* description, std::uint32_t size) {
    return make_handle([&] {
        const json options = json::parse(text_at(description, size));
        return Collision(Simulation(
            deformable_of(values_at(positions, particle_count), values_at(faces, face_count)),
            colliders_of(options.at("colliders"), values_at(maps, map_count)), options_of(options)));
    });
}
ECHINUS_EXPORT(collision_delete) void collision_delete(Collision* collision) {
    delete collision;
}

/// From its pose now the collider comes to this one in the next step.
ECHINUS_EXPORT(collision_set_pose)
bool collision_set_pose(Collision* collision, std::uint32_t collider, double x, double y, double z,
                        double rotation_w, double rotation_x, double rotation_y, double rotation_z) {
    return guarded([&] {
        collision->simulation.set_collider_pose(
            collider, {{rotation_w, rotation_x, rotation_y, rotation_z}, {x, y, z}});
        return true;
    });
}

ECHINUS_EXPORT(collision_correct) bool collision_correct(Collision* collision, double seconds) {
    return guarded([&] {
        correct(*collision, seconds);
        return true;
    });
}

ECHINUS_EXPORT(collision_positions) const Vec3f* collision_positions(const Collision* collision) {
    return collision->positions.data();
}
ECHINUS_EXPORT(collision_velocities) const Vec3f* collision_velocities(const Collision* collision) {
    return collision->velocities.data();
}
ECHINUS_EXPORT(collision_corrected) const std::uint32_t* collision_corrected(const Collision* collision) {
    return collision->corrected.data();
}
ECHINUS_EXPORT(collision_corrected_count)
std::uint32_t collision_corrected_count(const Collision* collision) {
    return static_cast<std::uint32_t>(collision->corrected.size());
}
/// How often surfaces left a particle no proven place.
ECHINUS_EXPORT(collision_squeezed_count) double collision_squeezed_count(const Collision* collision) {
    return static_cast<double>(collision->simulation.profile().squeezed_count);
}

} // namespace echinus::wasm
