#include "simulation/state/fingerprint.hpp"

#include "simulation/state/state_archive.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <set>
#include <utility>
#include <variant>

namespace echinus {

namespace {

/// Hashes its arguments in the form in which StateArchive would write them.
class Hasher {
  public:
    template <typename... Values>
    void add(const Values&... values) {
        (add_one(values), ...);
    }
    template <typename T>
    void add_all(const std::vector<T>& values) {
        add(std::uint64_t{values.size()});
        for (const T& v : values) add(v);
    }
    std::uint64_t hash() {
        const std::vector<std::byte>& bytes = archive_.written();
        return XXH64(bytes.data(), bytes.size(), 0);
    }

  private:
    template <typename T>
    void add_one(T v) {
        if constexpr (std::is_same_v<T, bool>)
            archive_.flag(v);
        else if constexpr (std::is_enum_v<T>)
            archive_.choice(v, v);
        else
            archive_.value(v);
    }

    StateArchive archive_;
};

} // namespace

std::uint64_t hash_of(const SimulationOptions& options) {
    Hasher hasher;
    hasher.add(options.kind(), options.time_step, options.gravity, options.thickness.value_or(-1),
               options.friction, options.rest.distance, options.rest.speed, options.rest.frame_count,
               options.allow_open_colliders, options.bound, options.wind, options.wind_rate);
    if (const auto* newton = std::get_if<NewtonOptions>(&options.solver))
        hasher.add(newton->material.density, newton->material.stretch_stiffness,
                   newton->material.shear_stiffness, newton->material.bending_stiffness,
                   newton->material.damping, newton->step_count, newton->tolerance, newton->air_drag,
                   newton->pressure, newton->collision, newton->self_thickness.value_or(-1));
    else
        hasher.add(options.jakobsen().iteration_count, options.jakobsen().drag, options.jakobsen().stiffness,
                   options.jakobsen().keep_free);
    return hasher.hash();
}

std::uint64_t hash_of(const Deformable& deformable, std::uint64_t start_hash) {
    Hasher hasher;
    hasher.add(start_hash);
    hasher.add_all(deformable.inverse_masses);
    hasher.add_all(deformable.faces);
    for (const DistanceConstraint& constraint : deformable.constraints)
        hasher.add(constraint.a, constraint.b, constraint.rest_length, constraint.kind);
    for (const Attachment& attachment : deformable.attachments)
        hasher.add(attachment.particle, attachment.collider);
    // The input may be in any order, with duplicates.
    std::set<std::pair<std::uint32_t, std::uint32_t>> filters;
    for (const CollisionFilter& filter : deformable.filters)
        filters.emplace(filter.collider, filter.particle);
    for (const auto& [collider, particle] : filters) hasher.add(collider, particle);
    for (const ElasticTetrahedron& t : deformable.tetrahedra)
        hasher.add(t.particles, t.gradients, t.volume, t.mu, t.lambda, t.damping);
    for (const Handle& handle : deformable.handles) {
        hasher.add_all(handle.particles);
        hasher.add(handle.release_time, std::uint64_t{handle.keys.size()});
        for (const auto& [time, pose] : handle.keys) {
            const auto& [w, x, y, z] = pose.rotation;
            hasher.add(time, w, x, y, z, pose.translation);
        }
    }
    if (!deformable.rest_positions.empty()) hasher.add_all(deformable.rest_positions);
    return hasher.hash();
}

std::uint64_t hash_of(std::span<const Vec3f> places) {
    return XXH64(places.data(), places.size_bytes(), 0);
}

std::uint64_t hash_of(const ColliderMap& map, const Vec3d& scale, const RigidTransform& start) {
    const auto& [rotation, translation] = start;
    Hasher hasher;
    hasher.add(scale, rotation.w, rotation.x, rotation.y, rotation.z, translation,
               std::uint64_t{map.kind.index()});
    if (const auto* exact = std::get_if<ExactMap>(&map.kind)) hasher.add(exact->source_hash());
    if (const auto* distance = std::get_if<DistanceMap>(&map.kind)) hasher.add(distance->source_hash());
    if (map.surface) hasher.add(map.surface->source_hash());
    return hasher.hash();
}

} // namespace echinus
