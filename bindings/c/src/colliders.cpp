#include "border.hpp"
#include "handles.hpp"

#include <cmath>

namespace echinus::c {

ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_pose, translation);
ECHINUS_REQUIRE_NO_PADDING_AFTER(echinus_collider, angular_velocity);

RigidTransform pose_from(const echinus_pose& pose) {
    const double(&r)[4] = pose.rotation;
    return {{r[0], r[1], r[2], r[3]}, vector_of(pose.translation)};
}

echinus_pose pose_to_c(const RigidTransform& pose) {
    const Rotation& r = pose.rotation;
    echinus_pose result{{r.w, r.x, r.y, r.z}, {}};
    put_vector(pose.translation, result.translation);
    return result;
}

RigidTransform checked_pose(const echinus_pose& pose, const char* name) {
    RigidTransform result = pose_from(pose);
    const Rotation& r = result.rotation;
    // The same check as in a simulation. Written so that NaN is refused.
    constexpr double kTolerance = 1e-4;
    if (!(std::fabs(std::sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z) - 1) <= kTolerance))
        throw WrongArgument(std::string(name) + ": the rotation is not of unit length");
    if (!is_finite(result.translation))
        throw WrongArgument(std::string(name) + ": the translation is not finite");
    return result;
}

std::vector<PoseKey> keys_from(std::span<const echinus_pose_key> keys) {
    std::vector<PoseKey> result;
    for (const echinus_pose_key& key : keys) result.push_back({key.time, pose_from(key.pose)});
    return result;
}

namespace {

/// Checks the preconditions of pose_at().
void require_valid(std::span<const echinus_pose_key> keys) {
    require(!keys.empty(), "there is no key");
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const std::string name = "key " + std::to_string(i);
        checked_pose(keys[i].pose, name.c_str());
        if (!std::isfinite(keys[i].time) || (i > 0 && !(keys[i].time > keys[i - 1].time)))
            throw WrongArgument(name + ": its time is not finite, or not later than the one before it");
    }
}

echinus_collider at_rest(const echinus_map* map) {
    echinus_collider result{};
    result.map = map;
    result.pose = pose_to_c(RigidTransform{});
    for (double& s : result.scale) s = 1;
    return result;
}

bool is_finite_and_not_0(const double (&scale)[3]) {
    for (const double s : scale)
        if (!std::isfinite(s) || s == 0) return false;
    return true;
}

} // namespace

Collider collider_from(const echinus_collider& collider) {
    return {.map = at(collider.map, "the map of the collider").value,
            .pose = pose_from(collider.pose),
            .scale = vector_of(collider.scale),
            .linear_velocity = vector_of(collider.linear_velocity),
            .angular_velocity = vector_of(collider.angular_velocity)};
}

std::vector<Collider> colliders_from(const echinus_collider* first, std::size_t count) {
    std::vector<Collider> result;
    if (count == 0) return result;
    const std::size_t size = at(first, "colliders").size;
    require_size(size, sizeof *first, sizeof *first, "colliders");
    times(count, size, "colliders");
    for (std::size_t i = 0; i < count; ++i) {
        const auto* place = reinterpret_cast<const std::byte*>(first) + i * size;
        const auto& given = *reinterpret_cast<const echinus_collider*>(place);
        require(given.size == size, "the colliders have different sizes");
        result.push_back(collider_from(read_struct(&given, echinus_collider{}, "colliders")));
    }
    return result;
}

Collider collider_at(const echinus_collider* collider) {
    const echinus_collider given = read_struct(collider, at_rest(nullptr), "collider");
    checked_pose(given.pose, "collider");
    require(is_finite_and_not_0(given.scale), "collider: the scale is 0 or not finite");
    return collider_from(given);
}

} // namespace echinus::c

using namespace echinus;
using namespace echinus::c;

void echinus_collider_init(echinus_collider* collider, size_t size, const echinus_map* map) {
    init_struct(collider, size, at_rest(map));
}

echinus_status echinus_rotation_about(const double* axis, double angle_rad, double* rotation) {
    return guarded(__func__, [&] {
        const Vec3d about = finite_vector_at(axis, "axis");
        require(about != Vec3d{}, "axis is zero");
        require(std::isfinite(angle_rad), "angle_rad is not finite");
        at(rotation, "rotation");
        const Rotation result = Rotation::about(about, angle_rad);
        rotation[0] = result.w;
        rotation[1] = result.x;
        rotation[2] = result.y;
        rotation[3] = result.z;
    });
}

echinus_status echinus_collider_velocity_at(const echinus_collider* collider, const double* point,
                                            double* velocity) {
    return guarded(__func__, [&] {
        at(velocity, "velocity");
        put_vector(velocity_at(collider_at(collider), finite_vector_at(point, "point")), velocity);
    });
}

echinus_status echinus_collider_pose_after(const echinus_collider* collider, double seconds,
                                           echinus_pose* pose) {
    return guarded(__func__, [&] {
        require(std::isfinite(seconds), "seconds is not finite");
        at(pose, "pose") = pose_to_c(pose_after(collider_at(collider), seconds));
    });
}

echinus_status echinus_pose_at(const echinus_pose_key* keys, size_t key_count, double seconds,
                               echinus_pose* pose) {
    return guarded(__func__, [&] {
        const std::span<const echinus_pose_key> given = values_at(keys, key_count, "keys");
        require_valid(given);
        require(std::isfinite(seconds), "seconds is not finite");
        at(pose, "pose") = pose_to_c(pose_at(keys_from(given), seconds));
    });
}
