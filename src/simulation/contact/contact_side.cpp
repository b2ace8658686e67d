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

/// The motion that all have in common between two states. It changes no gap of the surface to itself.
Vec3f ContactSide::common_motion(const PointArrays& from, const PointArrays& to) const {
    if (!pairs.is_of_itself()) return {};
    Vec3d sum;
    for (std::size_t i = 0; i < own->vertex_count(); ++i) sum += Vec3d(to[i] - from[i]);
    return Vec3f(sum * (1 / static_cast<double>(own->vertex_count())));
}

bool ContactSide::covers(const PointArrays& in_frame) const {
    if (!is_listed()) return false;
    const float most_sq = pairs.covered() * pairs.covered();
    const auto is_near = [&](const PointArrays& places) {
        const Vec3f common = common_motion(places, in_frame);
        for (std::size_t i = 0; i < own->vertex_count(); ++i) {
            const Vec3f away = in_frame[i] - places[i] - common;
            if (!(dot(away, away) <= most_sq)) return false;
        }
        return true;
    };
    return is_near(listed_from) || std::any_of(expected.begin(), expected.end(), is_near);
}

bool ContactSide::list(Places ends, const Workers& workers) {
    to_frame(ends, goal);
    if (covers(safe) && covers(goal)) return false;
    // Displacements of one beginning add to the list, so that the search for ends that are covered ends.
    const bool adds = is_listed() && listed_from == safe;
    if (!adds) expected.clear();
    listed_from = safe;
    is_elsewhere = true;
    expected.push_back(goal);
    pairs.list(safe, goal, obstacle_at(safe), obstacle_at(goal), adds, workers);
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
    const Vec3f common_past = common_motion(listed_from, safe), common_ahead = common_motion(safe, goal);
    for (std::size_t i = 0; i < count; ++i) {
        strayed[i] = length(safe[i] - listed_from[i] - common_past);
        ahead[i] =
            std::max(length(base[i] - safe[i] - common_ahead), length(goal[i] - safe[i] - common_ahead));
    }
    pairs.measure(safe, obstacle_at(safe), strayed, ahead, ready, is_elsewhere, workers);
    is_elsewhere = false;
}

} // namespace echinus
