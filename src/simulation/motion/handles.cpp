#include "simulation/motion/handles.hpp"

#include "simulation/motion/collider_motions.hpp"

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

RigidTransform start_of(const Handle& handle) {
    return handle.keys.empty() ? RigidTransform{} : pose_at(handle.keys, 0);
}

} // namespace

Handles::Handles(const Deformable& deformable) {
    for (const Handle& handle : deformable.handles) {
        Held& held = held_.emplace_back();
        held.handle = handle;
        for (PoseKey& key : held.handle.keys) key.pose.rotation = key.pose.rotation.normalised();
        const RigidTransform start = start_of(held.handle);
        for (const std::uint32_t particle : handle.particles)
            held.places.push_back(start.to_local(Vec3d(deformable.positions[particle])));
    }
}

/// A particle whose path is at rest is not moved, not even by rounding.
bool Handles::moves(const Held& held, double from_time, double to_time) {
    const std::vector<PoseKey>& keys = held.handle.keys;
    return !held.is_open && !keys.empty() && to_time > keys.front().time && from_time < keys.back().time;
}

Vec3d Handles::place_at(const Held& held, std::size_t number, const RigidTransform& pose) const {
    return moved_.to_world(pose.to_world(held.places[number]));
}

void Handles::follow(double from_time, double to_time, PointArrays& positions) const {
    for (const Held& held : held_) {
        if (!moves(held, from_time, to_time)) continue;
        const RigidTransform pose = pose_at(held.handle.keys, to_time);
        for (std::size_t n = 0; n < held.places.size(); ++n)
            positions.set(held.handle.particles[n], Vec3f(place_at(held, n, pose)));
    }
}

bool Handles::all_done(double time) const {
    return std::all_of(held_.begin(), held_.end(), [&](const Held& held) {
        if (held.is_open) return true;
        const bool lets_go = held.handle.release_time < std::numeric_limits<double>::infinity();
        return !lets_go && (held.handle.keys.empty() || held.handle.keys.back().time <= time);
    });
}

void Handles::move(const RigidTransform& motion) {
    moved_ = after(motion, moved_);
}

} // namespace echinus
