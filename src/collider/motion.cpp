#include <echinus/collider.hpp>

#include <algorithm>

namespace echinus {

Vec3d velocity_at(const Collider& collider, const Vec3d& point_world) {
    return collider.linear_velocity +
           cross(collider.angular_velocity, point_world - collider.pose.translation);
}

RigidTransform pose_after(const Collider& collider, double seconds) {
    RigidTransform pose = collider.pose;
    pose.translation += collider.linear_velocity * seconds;
    const double speed = length(collider.angular_velocity);
    if (speed == 0) return pose;
    const Rotation turn = Rotation::about(collider.angular_velocity, speed * seconds);
    pose.rotation = (turn * pose.rotation).normalised();
    return pose;
}

void head_for(Collider& collider, const RigidTransform& pose, double seconds) {
    const Rotation turn = (pose.rotation * collider.pose.rotation.inverse()).normalised();
    collider.linear_velocity = (pose.translation - collider.pose.translation) * (1 / seconds);
    collider.angular_velocity = turn.vector() * (1 / seconds);
}

RigidTransform pose_at(std::span<const PoseKey> keys, double seconds) {
    const auto next = std::upper_bound(keys.begin(), keys.end(), seconds,
                                       [](double time, const PoseKey& key) { return time < key.time; });
    if (next == keys.begin()) return keys.front().pose;
    const PoseKey& before = *(next - 1);
    if (next == keys.end()) return before.pose;
    const double share = (seconds - before.time) / (next->time - before.time);
    const Rotation turn = (next->pose.rotation * before.pose.rotation.inverse()).normalised();
    const Vec3d way = turn.vector();
    RigidTransform pose = before.pose;
    pose.translation += (next->pose.translation - before.pose.translation) * share;
    if (way != Vec3d{})
        pose.rotation = (Rotation::about(way, length(way) * share) * pose.rotation).normalised();
    return pose;
}

std::vector<Vec3f> vertices_at(const VertexCache& cache, double seconds) {
    const auto last = static_cast<double>(cache.sample_count() - 1);
    const double place = std::clamp((seconds - cache.start_time) / cache.sample_seconds, 0.0, last);
    const auto sample = static_cast<std::size_t>(place);
    const auto share = static_cast<float>(place - static_cast<double>(sample));
    const Vec3f* from = cache.samples->data() + sample * cache.vertex_count;
    std::vector<Vec3f> vertices(from, from + cache.vertex_count);
    if (share > 0)
        for (std::size_t i = 0; i < vertices.size(); ++i)
            vertices[i] += (from[cache.vertex_count + i] - from[i]) * share;
    return vertices;
}

} // namespace echinus
