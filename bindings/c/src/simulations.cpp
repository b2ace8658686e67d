#include "border.hpp"
#include "handles.hpp"
#include "options.hpp"

#include <echinus/error.hpp>

#include <cmath>

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_simulation_profile, unresolved_count);

namespace {

echinus_simulation_profile as_c(const SimulationProfile& profile) {
    const auto& [integration_seconds, constraint_seconds, collision_seconds, query_count, contact_count,
                 map_query_count, rescued_count, lost_count, truncated_count, measured_pair_count,
                 unresolved_count] = profile;
    return {0,           integration_seconds, constraint_seconds,  collision_seconds,
            query_count, contact_count,       map_query_count,     rescued_count,
            lost_count,  truncated_count,     measured_pair_count, unresolved_count};
}

/// @throws WrongArgument for null
const Simulation& simulation_at(const echinus_simulation* simulation) {
    return at(simulation, "simulation").value;
}

/// A simulation that may be changed.
/// @throws WrongArgument for null, Error Diverged for one that can only be read
Simulation& running_at(echinus_simulation* simulation) {
    if (at(simulation, "simulation").failed)
        throw Error(ErrorCode::Diverged, "a step of the simulation failed before; it can only be read");
    return simulation->value;
}

} // namespace

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

echinus_status echinus_simulation_create(const echinus_deformable* deformable,
                                         const echinus_collider* colliders, size_t collider_count,
                                         const echinus_simulation_options* options,
                                         echinus_simulation** simulation) {
    return make(__func__, simulation, [&] {
        return Simulation(at(deformable, "deformable").value, colliders_from(colliders, collider_count),
                          options_from(options));
    });
}

echinus_status echinus_simulation_copy(const echinus_simulation* simulation, echinus_simulation** copy) {
    return make(__func__, copy, [&] { return at(simulation, "simulation"); });
}

void echinus_simulation_destroy(echinus_simulation* simulation) {
    delete simulation;
}

echinus_status echinus_simulation_save_state(const echinus_simulation* simulation, echinus_array** state) {
    return make(__func__, state, [&] { return array_of(simulation_at(simulation).save_state()); });
}

echinus_status echinus_simulation_restored(const echinus_simulation* simulation, const void* bytes,
                                           size_t byte_count, echinus_simulation** restored) {
    return make(__func__, restored, [&] {
        Simulation copy = simulation_at(simulation);
        copy.restore_state(values_at(static_cast<const std::byte*>(bytes), byte_count, "bytes"));
        return copy;
    });
}

echinus_status echinus_simulation_step(echinus_simulation* simulation) {
    const echinus_status status = guarded(__func__, [&] { running_at(simulation).step(); });
    if (status != ECHINUS_OK && simulation != nullptr) simulation->failed = true;
    return status;
}

size_t echinus_simulation_particle_count(const echinus_simulation* simulation) {
    return simulation == nullptr ? 0 : simulation->value.positions().size();
}
const float* echinus_simulation_positions(const echinus_simulation* simulation) {
    return simulation == nullptr ? nullptr
                                 : reinterpret_cast<const float*>(simulation->value.positions().data());
}
echinus_status echinus_simulation_read(const echinus_simulation* simulation,
                                       echinus_deformable_arrays* arrays) {
    return guarded(
        __func__, [&] { write_struct(arrays, arrays_of(simulation_at(simulation).deformable()), "arrays"); });
}

uint32_t echinus_simulation_frame(const echinus_simulation* simulation) {
    return simulation == nullptr ? 0 : simulation->value.frame();
}
int32_t echinus_simulation_at_rest(const echinus_simulation* simulation) {
    return simulation != nullptr && simulation->value.at_rest() ? 1 : 0;
}
double echinus_simulation_largest_speed(const echinus_simulation* simulation) {
    return simulation == nullptr ? 0 : simulation->value.largest_speed();
}
uint64_t echinus_simulation_state_hash(const echinus_simulation* simulation) {
    return simulation == nullptr ? 0 : simulation->value.state_hash();
}

echinus_status echinus_simulation_read_profile(const echinus_simulation* simulation,
                                               echinus_simulation_profile* profile) {
    return guarded(__func__,
                   [&] { write_struct(profile, as_c(simulation_at(simulation).profile()), "profile"); });
}
echinus_status echinus_simulation_residual(const echinus_simulation* simulation, double* root_mean_square,
                                           double* largest) {
    return guarded(__func__, [&] {
        const Residual residual = simulation_at(simulation).residual();
        at(root_mean_square, "root_mean_square") = residual.root_mean_square;
        at(largest, "largest") = residual.largest;
    });
}
echinus_status echinus_simulation_read_options(const echinus_simulation* simulation,
                                               echinus_simulation_options* options) {
    return guarded(__func__,
                   [&] { write_struct(options, as_c(simulation_at(simulation).options()), "options"); });
}

size_t echinus_simulation_collider_count(const echinus_simulation* simulation) {
    return simulation == nullptr ? 0 : simulation->value.colliders().size();
}
echinus_status echinus_simulation_read_collider(const echinus_simulation* simulation, size_t index,
                                                echinus_collider* collider) {
    return guarded(__func__, [&] {
        const std::vector<Collider>& colliders = simulation_at(simulation).colliders();
        require_index(index, colliders.size(), "collider");
        echinus_collider result{};
        // A different map in each frame if the collider deforms.
        simulation->maps[index].value = colliders[index].map;
        result.map = &simulation->maps[index];
        result.pose = pose_to_c(colliders[index].pose);
        put_vector(colliders[index].scale, result.scale);
        put_vector(colliders[index].linear_velocity, result.linear_velocity);
        put_vector(colliders[index].angular_velocity, result.angular_velocity);
        write_struct(collider, result, "collider");
    });
}

echinus_status echinus_simulation_set_collider_velocity(echinus_simulation* simulation, size_t index,
                                                        const double* linear, const double* angular) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_velocity(index, finite_vector_at(linear, "linear"),
                                      finite_vector_at(angular, "angular"));
    });
}

echinus_status echinus_simulation_set_collider_pose(echinus_simulation* simulation, size_t index,
                                                    const echinus_pose* pose) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_pose(index, checked_pose(at(pose, "pose"), "pose"));
    });
}

echinus_status echinus_simulation_set_collider_keyframes(echinus_simulation* simulation, size_t index,
                                                         const echinus_pose_key* keys, size_t key_count) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_keyframes(index, keys_from(values_at(keys, key_count, "keys")));
    });
}

echinus_status echinus_simulation_set_collider_vertices(echinus_simulation* simulation, size_t index,
                                                        const float* vertices, size_t vertex_count,
                                                        size_t vertex_stride) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_vertices(index, points_from(vertices, vertex_count, vertex_stride, "vertices"));
    });
}

echinus_status echinus_simulation_set_collider_cache(echinus_simulation* simulation, size_t index,
                                                     const echinus_vertex_cache* cache) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_cache(index, at(cache, "cache").value);
    });
}

echinus_status echinus_simulation_load_on(const echinus_simulation* simulation, size_t index, double* force,
                                          double* torque) {
    return guarded(__func__, [&] {
        const Simulation& measured = simulation_at(simulation);
        require_index(index, measured.colliders().size(), "collider");
        const Load load = measured.load_on(index);
        put_vector(load.force, &at(force, "force"));
        put_vector(load.torque, &at(torque, "torque"));
    });
}

echinus_status echinus_simulation_set_collider_free(echinus_simulation* simulation, size_t index,
                                                    double mass) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(index, running.colliders().size(), "collider");
        running.set_collider_free(index, mass);
    });
}

echinus_status echinus_simulation_record_contacts(echinus_simulation* simulation, int32_t is_on) {
    return guarded(__func__, [&] { running_at(simulation).record_contacts(is_on != 0); });
}

echinus_status echinus_simulation_contact_points(const echinus_simulation* simulation,
                                                 echinus_array** points) {
    return make(__func__, points, [&] {
        std::vector<echinus_contact_point> made;
        for (const ContactPoint& point : simulation_at(simulation).contact_points()) {
            echinus_contact_point& c = made.emplace_back();
            put_vector(point.position, c.position);
            put_vector(point.normal, c.normal);
            put_vector(point.friction_impulse, c.friction_impulse);
            c.gap = point.gap;
            c.normal_impulse = point.normal_impulse;
            c.collider = point.collider;
            std::copy(point.particles.begin(), point.particles.end(), c.particles);
        }
        return array_of(std::move(made));
    });
}

echinus_status echinus_simulation_set_particle_velocity(echinus_simulation* simulation, size_t particle,
                                                        const double* velocity) {
    return guarded(__func__, [&] {
        Simulation& running = running_at(simulation);
        require_index(particle, running.positions().size(), "particle");
        running.set_particle_velocity(particle, finite_vector_at(velocity, "velocity"));
    });
}

echinus_status echinus_simulation_blow(echinus_simulation* simulation, const double* wind, double rate) {
    return guarded(__func__, [&] {
        require(std::isfinite(rate) && rate >= 0, "rate is negative or not finite");
        running_at(simulation).blow(finite_vector_at(wind, "wind"), rate);
    });
}
