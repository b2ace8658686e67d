#include "border.hpp"
#include "handles.hpp"
#include "options.hpp"

#include <echinus/particle_collision.hpp>
#include <echinus/surface_collision.hpp>

struct echinus_particle_collision {
    echinus::ParticleCollision value;
};
struct echinus_surface_collision {
    echinus::SurfaceCollision value;
};

namespace echinus::c {

namespace {

template <typename Collision>
void set_collider_pose(Collision* collision, std::size_t index, const echinus_pose* pose) {
    auto& value = at(collision, "collision").value;
    require_index(index, value.colliders().size(), "collider");
    value.set_collider_pose(index, checked_pose(at(pose, "pose"), "pose"));
}

std::span<Vec3f> vectors_at(float* first, std::size_t count, const char* name) {
    return values_at(reinterpret_cast<Vec3f*>(first), count, name);
}
/// Empty if the pointer is null.
template <typename T>
std::span<T> optional_at(T* first, std::size_t count, const char* name) {
    return first == nullptr ? std::span<T>() : values_at(first, count, name);
}

void put(std::span<const std::uint32_t> result, const std::uint32_t** corrected, std::size_t* count) {
    if (corrected != nullptr) *corrected = result.data();
    if (count != nullptr) *count = result.size();
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_particle_collision_create(const echinus_collider* colliders, size_t collider_count,
                                                 double thickness,
                                                 const echinus_particle_collision_options* options,
                                                 echinus_particle_collision** collision) {
    return make(__func__, collision, [&] {
        return ParticleCollision(colliders_from(colliders, collider_count), thickness, options_from(options));
    });
}

void echinus_particle_collision_destroy(echinus_particle_collision* collision) {
    delete collision;
}

echinus_status echinus_particle_collision_set_collider_pose(echinus_particle_collision* collision,
                                                            size_t index, const echinus_pose* pose) {
    return guarded(__func__, [&] { set_collider_pose(collision, index, pose); });
}

echinus_status echinus_particle_collision_place_collider(echinus_particle_collision* collision, size_t index,
                                                         const echinus_pose* pose) {
    return guarded(__func__, [&] {
        ParticleCollision& value = at(collision, "collision").value;
        require_index(index, value.colliders().size(), "collider");
        value.place_collider(index, checked_pose(at(pose, "pose"), "pose"));
    });
}

echinus_status echinus_particle_collision_set_collider_friction(echinus_particle_collision* collision,
                                                                size_t index, double friction) {
    return guarded(__func__, [&] {
        ParticleCollision& value = at(collision, "collision").value;
        require_index(index, value.colliders().size(), "collider");
        value.set_collider_friction(index, friction);
    });
}

echinus_status echinus_particle_collision_correct(echinus_particle_collision* collision,
                                                  const float* previous_positions, float* positions,
                                                  float* velocities, const float* inverse_masses,
                                                  size_t particle_count, double seconds,
                                                  const uint32_t** corrected, size_t* corrected_count) {
    return guarded(__func__, [&] {
        const auto* previous = reinterpret_cast<const Vec3f*>(previous_positions);
        const SolverStep step{
            .previous_positions = values_at(previous, particle_count, "previous_positions"),
            .positions = vectors_at(positions, particle_count, "positions"),
            .velocities = optional_at(reinterpret_cast<Vec3f*>(velocities), particle_count, "velocities"),
            .inverse_masses = optional_at(inverse_masses, particle_count, "inverse_masses")};
        put(at(collision, "collision").value.correct(step, seconds), corrected, corrected_count);
    });
}

uint64_t echinus_particle_collision_lost_count(const echinus_particle_collision* collision) {
    return collision == nullptr ? 0 : collision->value.lost_count();
}

echinus_status echinus_surface_collision_create(const float* positions, size_t particle_count,
                                                const uint32_t* faces, size_t face_count,
                                                const echinus_collider* colliders, size_t collider_count,
                                                double thickness,
                                                const echinus_surface_collision_options* options,
                                                echinus_surface_collision** collision) {
    return make(__func__, collision, [&] {
        return SurfaceCollision(points_from(positions, particle_count, 0, "positions"),
                                faces_from(faces, face_count, "faces"),
                                colliders_from(colliders, collider_count), thickness, options_from(options));
    });
}

void echinus_surface_collision_destroy(echinus_surface_collision* collision) {
    delete collision;
}

echinus_status echinus_surface_collision_set_collider_pose(echinus_surface_collision* collision, size_t index,
                                                           const echinus_pose* pose) {
    return guarded(__func__, [&] { set_collider_pose(collision, index, pose); });
}

echinus_status echinus_surface_collision_correct(echinus_surface_collision* collision, float* positions,
                                                 float* velocities, size_t particle_count, double seconds,
                                                 const uint32_t** corrected, size_t* corrected_count) {
    return guarded(__func__, [&] {
        const auto moved = vectors_at(positions, particle_count, "positions");
        const auto with = optional_at(reinterpret_cast<Vec3f*>(velocities), particle_count, "velocities");
        put(at(collision, "collision").value.correct(moved, with, seconds), corrected, corrected_count);
    });
}

const float* echinus_surface_collision_positions(const echinus_surface_collision* collision) {
    return collision == nullptr ? nullptr
                                : reinterpret_cast<const float*>(collision->value.positions().data());
}

uint64_t echinus_surface_collision_unresolved_count(const echinus_surface_collision* collision) {
    return collision == nullptr ? 0 : collision->value.unresolved_count();
}
