#pragma once

#include <echinus/any_map.hpp>
#include <echinus/contact.hpp>
#include <echinus/custom_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <variant>

ECHINUS_EXPORT_BEGIN

/// A map placed in the world. Points, normals, depths and margins are in world units and world axes here.
namespace echinus {

/// What a collider asks: a map of either kind, or one of the user's own.
struct ColliderMap : std::variant<DistanceMap, ExactMap, std::shared_ptr<const CustomMap>> {
    using variant::variant;
    ColliderMap(const AnyMap& map)
        : variant(std::visit([](const auto& kind) { return variant(kind); }, map)) {}
};

/// A rigid model in the world: its map, where it stands, how large it is and how it moves. A plain value;
/// maps share their arrays, so copies are cheap.
///
/// point_world = pose.to_world(scale * point_local), component by component
struct Collider {
    ColliderMap map; ///< not a null pointer
    RigidTransform pose{};
    /// Along the map's axes. Three equal numbers: another size. Others stretch the model, and a negative one
    /// mirrors it; what is inside stays inside, and normals point out of the solid. Not 0, and finite.
    Vec3d scale{1, 1, 1};
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
// NaN or infinity in a point: outside, no contact, nothing met.
// Cost per call: the map's query, and once the pose as a matrix; a batch pays for the matrix once.
// @pre scale is finite and has no 0, and a custom map is not null

bool contains(const Collider& collider, Vec3f point_world) noexcept;

/// Where nothing is found, `point` is the particle itself, bit for bit.
///
/// An exact map gives the point of the scaled surface that is nearest in the world, its distance and the
/// normal of the scaled surface. A distance map gives the point on the ray from the centre, as always; depth
/// and margin are world lengths along that ray, and the normal goes by the inverse transpose of the scale.
/// Three scales of one size cost nothing more with either map. A custom map is asked for the margin that the
/// smallest scale makes widest, and its point and normal are scaled like a distance map's; what it answers
/// beyond the margin is passed on.
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

/// Where a particle first meets a collider that moves and turns while the particle moves: the first crossing
/// of the chord between the particle's local position under the previous pose and the one under the present
/// pose. Seen from the collider, every way is a chord; over a frame in which it turns by the angle a, chord
/// and true way differ by at most a^2 / 8 of the distance from the axis. The scale is the same at both ends.
///
/// `point` and `normal` are in the world where the collider is now: `point` is where the surface that was met
/// now lies, and `to_world` when nothing is met. `entering` tells front from back as the map does.
/// A distance map and a custom one have no sweep: with them, nothing is met.
SweepHit sweep(const Collider& collider, const RigidTransform& previous_pose, Vec3f from_world,
               Vec3f to_world) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
