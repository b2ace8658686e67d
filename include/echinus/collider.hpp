#pragma once

#include <echinus/contact.hpp>
#include <echinus/distance_map.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>
#include <span>

/// A map placed in the world. Points, normals, depths and margins are in world units and world axes here.
namespace echinus {

/// A rigid model in the world: its map, where it stands, how large it is and how it moves. A plain value;
/// maps share their arrays, so copies are cheap.
///
/// point_world = pose.to_world(scale * point_local)
struct Collider {
    DistanceMap map;
    RigidTransform pose{};
    double scale = 1;         ///< uniform, positive
    Vec3d linear_velocity{};  ///< of the pose's translation, units per second
    Vec3d angular_velocity{}; ///< about the pose's translation, world axes, radians per second

    bool moves() const { return linear_velocity != Vec3d{} || angular_velocity != Vec3d{}; }
};

/// Velocity of the collider's material at a point, units per second.
Vec3d velocity_at(const Collider& collider, const Vec3d& point_world);

/// The pose a time later. Exact for constant velocities, to rounding; the same bits on every system.
RigidTransform pose_after(const Collider& collider, double seconds);

// Queries: as those of the map. noexcept, no allocation, any number of threads. A point is taken to the local
// frame in double and rounded to float there, so a collider may stand far from the origin as long as the
// caller's float positions still resolve it. A point that overflows float in the local frame is outside.
// Cost per call: the map's query, and once the pose as a matrix; a batch pays for the matrix once.

bool contains(const Collider& collider, Vec3f point_world) noexcept;

/// Where nothing is found, `point` is the particle itself, bit for bit.
Contact contact(const Collider& collider, Vec3f point_world, float margin_world = 0) noexcept;

/// @param points_world  [n]
/// @param inside        [n] out: 1 inside, 0 outside. Does not overlap points_world.
/// @pre points_world.size() == inside.size()
void contains_batch(const Collider& collider, StridedSpan<const Vec3f> points_world,
                    std::span<std::uint8_t> inside) noexcept;

/// @param points_world  [n]
/// @param contacts      [n] out. Does not overlap points_world.
/// @pre points_world.size() == contacts.size()
void contacts_batch(const Collider& collider, StridedSpan<const Vec3f> points_world, float margin_world,
                    std::span<Contact> contacts) noexcept;

} // namespace echinus
