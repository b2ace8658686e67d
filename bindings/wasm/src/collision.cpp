// Collision for particles that another solver moves, or for the faces between them, with the arrays that
// JavaScript reads and writes.

#include "interface.hpp"
#include "options.hpp"

#include <echinus/particle_collision.hpp>
#include <echinus/surface_collision.hpp>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <variant>
#include <vector>

namespace echinus::wasm {

namespace {

struct Collision {
    using Kind = std::variant<ParticleCollision, SurfaceCollision>;

    Collision(Kind kind_in, std::vector<Vec3f> start)
        : kind(std::move(kind_in)), positions(std::move(start)), previous(positions),
          velocities(positions.size()) {}

    Kind kind;
    std::vector<Vec3f> positions;  ///< as the other solver set them, then corrected
    std::vector<Vec3f> previous;   ///< the positions at the beginning of the step
    std::vector<Vec3f> velocities; ///< of the particles that were corrected
    std::span<const std::uint32_t> corrected{};
};

bool has_exploded(const Vec3f& p) {
    constexpr float kFarthest = ParticleCollision::kFarthest;
    return !(std::fabs(p.x) <= kFarthest && std::fabs(p.y) <= kFarthest && std::fabs(p.z) <= kFarthest);
}

/// A particle that has exploded continues from its previous position.
void correct(Collision& collision, double seconds) {
    auto& [kind, positions, previous, velocities, corrected] = collision;
    for (std::size_t i = 0; i < positions.size(); ++i)
        velocities[i] = (positions[i] - previous[i]) * static_cast<float>(1 / seconds);
    if (auto* particles = std::get_if<ParticleCollision>(&kind))
        corrected = particles->correct({previous, positions, velocities}, seconds);
    else
        corrected = std::get<SurfaceCollision>(kind).correct(positions, velocities, seconds);
    for (std::size_t i = 0; i < positions.size(); ++i)
        if (!has_exploded(positions[i])) previous[i] = positions[i];
}

} // namespace

ECHINUS_EXPORT(wasm_collision_make)
echinus_status wasm_collision_make(const echinus_deformable* deformable, const echinus_collider* row,
                                   std::size_t count, double thickness,
                                   const echinus_particle_collision_options* options, Collision** collision) {
    return make(__func__, collision, [&] {
        return Collision(ParticleCollision(colliders_from(row, count), thickness, options_from(options)),
                         deformable->value.positions);
    });
}
ECHINUS_EXPORT(wasm_collision_make_surfaces)
echinus_status wasm_collision_make_surfaces(const echinus_deformable* deformable, const echinus_collider* row,
                                            std::size_t count, double thickness,
                                            const echinus_surface_collision_options* options,
                                            Collision** collision) {
    return make(__func__, collision, [&] {
        const Deformable& given = deformable->value;
        SurfaceCollision surfaces(given.positions, given.faces, colliders_from(row, count), thickness,
                                  options_from(options));
        std::vector<Vec3f> start = surfaces.positions();
        return Collision(std::move(surfaces), std::move(start));
    });
}
ECHINUS_EXPORT(wasm_collision_delete) void wasm_collision_delete(Collision* collision) {
    delete collision;
}

ECHINUS_EXPORT(wasm_collision_set_pose)
echinus_status wasm_collision_set_pose(Collision* collision, std::size_t index, const echinus_pose* pose) {
    return guarded(__func__, [&] {
        std::visit(
            [&](auto& kind) {
                require_index(index, kind.colliders().size(), "collider");
                kind.set_collider_pose(index, checked_pose(*pose, "pose"));
            },
            collision->kind);
    });
}
ECHINUS_EXPORT(wasm_collision_correct)
echinus_status wasm_collision_correct(Collision* collision, double seconds) {
    return guarded(__func__, [&] { correct(*collision, seconds); });
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
std::size_t wasm_collision_corrected_count(const Collision* collision) {
    return collision->corrected.size();
}
ECHINUS_EXPORT(wasm_collision_unresolved_count)
double wasm_collision_unresolved_count(const Collision* collision) {
    const auto* surfaces = std::get_if<SurfaceCollision>(&collision->kind);
    return surfaces != nullptr ? static_cast<double>(surfaces->unresolved_count()) : 0;
}

/// The function that frees memory from memalign().
ECHINUS_EXPORT(wasm_free) void (*wasm_free())(void*) {
    return std::free;
}

} // namespace echinus::wasm
