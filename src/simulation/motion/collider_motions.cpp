#include "simulation/motion/collider_motions.hpp"

#include "simulation/start/validation.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace echinus {

RigidTransform after(const RigidTransform& motion, const RigidTransform& pose) {
    return {(motion.rotation * pose.rotation).normalised(), motion.to_world(pose.translation)};
}

void ColliderMotions::lead_to(std::size_t collider, const std::string& name, const RigidTransform& pose) {
    require_valid(pose, name);
    Motion& motion = motions_[collider];
    motion.is_led = true;
    motion.keys.clear();
    motion.body.reset();
    motion.is_unknown = false;
    motion.next = pose;
    motion.next->rotation = pose.rotation.normalised();
}

void ColliderMotions::follow(std::size_t collider, const std::string& name, std::vector<PoseKey> keys) {
    require_valid(keys, name);
    for (PoseKey& key : keys) key.pose.rotation = key.pose.rotation.normalised();
    motions_[collider] = {.is_led = true, .next = {}, .keys = std::move(keys)};
}

void ColliderMotions::begin_frame(std::vector<Collider>& colliders, double end_time, double frame_seconds,
                                  std::span<const Load> loads, const Vec3d& gravity) {
    for (std::size_t c = 0; c < motions_.size(); ++c) {
        Motion& motion = motions_[c];
        if (!motion.is_led) continue;
        if (motion.is_unknown) {
            motion.body->give_velocities(colliders[c]);
            continue;
        }
        if (motion.body) {
            motion.body->push(colliders[c].pose, loads[c], gravity, frame_seconds);
            motion.next = motion.body->after(colliders[c].pose, frame_seconds);
        }
        if (!motion.keys.empty()) motion.next = pose_at(motion.keys, end_time);
        // A collider that is led to its present pose does not move at all, not even by rounding.
        if (motion.next && motion.next != motion.last)
            head_for(colliders[c], *motion.next, frame_seconds);
        else
            colliders[c].linear_velocity = colliders[c].angular_velocity = {};
        if (motion.next) motion.last = std::exchange(motion.next, std::nullopt);
    }
}

void ColliderMotions::move(std::size_t collider, const RigidTransform& motion) {
    Motion& led = motions_[collider];
    for (PoseKey& key : led.keys) key.pose = after(motion, key.pose);
    if (led.next) led.next = after(motion, *led.next);
    if (led.last) led.last = after(motion, *led.last);
    if (led.body) led.body->turn(motion.rotation);
}

bool ColliderMotions::all_arrived(double time, double rest_speed) const {
    return std::all_of(motions_.begin(), motions_.end(), [&](const Motion& motion) {
        return (motion.keys.empty() || motion.keys.back().time <= time) &&
               (!motion.body || motion.body->is_slower_than(rest_speed));
    });
}

void ColliderMotions::archive(StateArchive& state) {
    for (Motion& motion : motions_) {
        state.flag(motion.is_led);
        const auto pose = [&](RigidTransform& place) { state.pose(place); };
        state.optional(motion.next, pose);
        state.optional(motion.last, pose);
        state.optional(motion.body, [&](RigidBody& body) { body.archive(state); });
        state.items(motion.keys, [&](PoseKey& key) {
            state.value(key.time);
            state.pose(key.pose);
        });
        for (std::size_t i = 1; i < motion.keys.size(); ++i)
            state.require(motion.keys[i].time > motion.keys[i - 1].time);
    }
}

} // namespace echinus
