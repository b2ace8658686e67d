#include "simulation/contact/contact_side.hpp"

#include <algorithm>

namespace echinus {

ContactSide::ContactSide(const ContactSide& other)
    : own(other.own), obstacle(other.obstacle), obstacle_places(other.obstacle_places),
      pairs(other.pairs.is_of_itself() ? PairSet(*own) : PairSet(*own, obstacle)), frame(other.frame),
      thickness(other.thickness), friction(other.friction), least_gap(other.least_gap), extent(other.extent),
      listed_from(other.listed_from), expected(other.expected) {
    pairs.set_reach(other.pairs.reach());
    pairs.set_pairs(other.pairs.pairs());
}

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
    expected = goal;
    pairs.list(safe, expected, obstacle_at(safe), obstacle_at(expected), workers);
    return true;
}

} // namespace echinus
