#include "simulation/contact/contact_side.hpp"

#include <algorithm>

namespace echinus {

void ContactSide::set_pose(const RigidTransform& pose) {
    const Rotation& r = pose.rotation;
    frame.reset();
    if (pose.translation != Vec3d{} || r.x != 0 || r.y != 0 || r.z != 0) frame.emplace(pose, Vec3d{1, 1, 1});
}

void ContactSide::to_frame(const PointArrays& world, PointArrays& result) const {
    if (!frame) {
        result = world;
        return;
    }
    result.resize(own->vertex_count());
    for (std::size_t i = 0; i < own->vertex_count(); ++i) result.set(i, frame->point_to_local(world[i]));
}

void ContactSide::to_frame(Places world, PointArrays& result) const {
    result.resize(own->vertex_count());
    for (std::size_t i = 0; i < own->vertex_count(); ++i)
        result.set(i, frame ? frame->point_to_local(Vec3f(world[i])) : Vec3f(world[i]));
}

namespace {

/// Is each point within a distance of its counterpart?
bool are_near(const PointArrays& a, const PointArrays& b, std::size_t count, float distance) {
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f away = a[i] - b[i];
        if (!(dot(away, away) <= distance * distance)) return false;
    }
    return true;
}

} // namespace

bool ContactSide::covers(const PointArrays& in_frame) const {
    if (!is_listed()) return false;
    const std::size_t count = own->vertex_count();
    return are_near(in_frame, expected, count, pairs.covered()) ||
           are_near(in_frame, listed_from, count, pairs.covered());
}

bool ContactSide::list(Places ends, const Workers& workers) {
    to_frame(ends, goal);
    if (covers(safe) && covers(goal)) return false;
    listed_from = safe;
    is_elsewhere = true;
    expected = goal;
    pairs.list(safe, expected, obstacle_at(safe), obstacle_at(expected), workers);
    return true;
}

void ContactSide::measure_towards(Places goals, const Workers& workers) {
    to_frame(goals, goal);
    base = goal;
    measure(workers);
}

void ContactSide::measure(const Workers& workers) {
    const std::size_t count = own->vertex_count();
    strayed.resize(count);
    ahead.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        strayed[i] = length(safe[i] - listed_from[i]);
        ahead[i] = std::max(length(base[i] - safe[i]), length(goal[i] - safe[i]));
    }
    pairs.measure(safe, obstacle_at(safe), strayed, ahead, ready, is_elsewhere, workers);
    is_elsewhere = false;
}

} // namespace echinus
