#pragma once

#include <echinus/contact.hpp>
#include <echinus/distance_map.hpp>
#include <echinus/geometry.hpp>

#include <span>

namespace echinus {

/// A rigid model in the world: its map, where it stands, how large it is and how it moves. A plain value;
/// maps share their arrays, so copies are cheap.
///
/// point_world = pose.to_world(scale * point_local)
struct Collider {
    DistanceMap map;
    RigidTransform pose;
    double scale = 1;       ///< uniform, positive
    Vec3d linear_velocity;  ///< of the pose's translation, units per second
    Vec3d angular_velocity; ///< about the pose's translation, world axes, radians per second
};

/// Velocity of the collider's material at a point, units per second.
Vec3d velocity_at(const Collider& collider, const Vec3d& point_world);

/// Moves the pose along its velocities for a time. Exact for constant velocities.
void advance(Collider& collider, double seconds);

// Queries in the world: as those of the map, with points, normals, depths and margin in world units.
// noexcept, no allocation, any number of threads.

bool contains(const Collider& collider, Vec3f point_world) noexcept;
Contact contact(const Collider& collider, Vec3f point_world, float margin_world = 0) noexcept;
void contains_batch(const Collider& collider, StridedSpan<const Vec3f> points_world,
                    std::span<std::uint8_t> inside) noexcept;
void contacts_batch(const Collider& collider, StridedSpan<const Vec3f> points_world, float margin_world,
                    std::span<Contact> contacts) noexcept;

} // namespace echinus
