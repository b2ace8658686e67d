#include "collider/frame_change.hpp"

#include <echinus/collider.hpp>

#include <algorithm>
#include <array>

namespace echinus {

namespace {

/// Points of a batch are taken to the local frame in pieces that stay in the first-level cache.
constexpr std::size_t kPieceSize = 256;

/// Calls `body(begin, points_local)` for consecutive pieces of a batch.
template <typename Body>
void for_each_piece(const FrameChange& frame, const StridedSpan<const Vec3f>& points_world,
                    const Body& body) {
    std::array<Vec3f, kPieceSize> points_local;
    for (std::size_t begin = 0; begin < points_world.size(); begin += kPieceSize) {
        const std::size_t count = std::min(kPieceSize, points_world.size() - begin);
        for (std::size_t i = 0; i < count; ++i)
            points_local[i] = frame.point_to_local(points_world[begin + i]);
        body(begin, std::span<const Vec3f>(points_local.data(), count));
    }
}

} // namespace

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

bool contains(const Collider& collider, Vec3f point_world) noexcept {
    return contains(collider.map, FrameChange(collider).point_to_local(point_world));
}

Contact contact(const Collider& collider, Vec3f point_world, float margin_world) noexcept {
    const FrameChange frame(collider);
    Contact found =
        contact(collider.map, frame.point_to_local(point_world), frame.length_to_local(margin_world));
    frame.contact_to_world(found, point_world);
    return found;
}

void contains_batch(const Collider& collider, StridedSpan<const Vec3f> points_world,
                    std::span<std::uint8_t> inside) noexcept {
    const FrameChange frame(collider);
    for_each_piece(frame, points_world, [&](std::size_t begin, std::span<const Vec3f> points_local) {
        contains_batch(collider.map, points_local, inside.subspan(begin, points_local.size()));
    });
}

void contacts_batch(const Collider& collider, StridedSpan<const Vec3f> points_world, float margin_world,
                    std::span<Contact> contacts) noexcept {
    const FrameChange frame(collider);
    const float margin_local = frame.length_to_local(margin_world);
    for_each_piece(frame, points_world, [&](std::size_t begin, std::span<const Vec3f> points_local) {
        const std::span<Contact> piece = contacts.subspan(begin, points_local.size());
        contacts_batch(collider.map, points_local, margin_local, piece);
        for (std::size_t i = 0; i < piece.size(); ++i)
            frame.contact_to_world(piece[i], points_world[begin + i]);
    });
}

} // namespace echinus
