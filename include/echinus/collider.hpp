#pragma once

#include <echinus/any_map.hpp>
#include <echinus/contact.hpp>
#include <echinus/custom_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/export.hpp>
#include <echinus/geometry.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

ECHINUS_EXPORT_BEGIN

/// Maps placed in the world. Points, normals, depths and margins in this header are in world units and axes.
namespace echinus {

/// The map of a collider: a distance map, an exact map or a custom map. A map of each of these kinds, and
/// AnyMap, converts to a ColliderMap.
struct ColliderMap {
    using Kind = std::variant<DistanceMap, ExactMap, std::shared_ptr<const CustomMap>>;
    Kind kind;
    /// If `kind` is not an exact map: the exact map of the same mesh, whose faces CollisionMode::Surfaces
    /// needs. Particles are then pushed out by `kind`, and surfaces are kept off these faces. Queries ignore
    /// this map.
    std::optional<ExactMap> surface{};

    template <std::convertible_to<Kind> Map>
    ColliderMap(Map&& map) : kind(std::forward<Map>(map)) {}
    ColliderMap(const AnyMap& map) : kind(std::visit([](const auto& known) { return Kind(known); }, map)) {}
};

/// A rigid model in the world: its map, pose, scale and motion. It is a plain value. Copies are cheap, since
/// copies of a map share its arrays.
///
/// point_world = pose.to_world(scale * (origin + point_local)), component by component. The origin is that
/// of the map (ExactMapView::origin); it is usually 0, and simulations accept only 0.
struct Collider {
    ColliderMap map;       ///< its map; a pointer to a custom map is not null
    RigidTransform pose{}; ///< its rotation has unit length
    /// Scale factors along the map's axes. Three equal factors change the size, different factors stretch the
    /// model, and negative factors mirror it. The inside stays inside, and normals point out of the solid in
    /// any case. All factors must be finite and not 0.
    Vec3d scale{1, 1, 1};
    Vec3d linear_velocity{};  ///< velocity of the pose's translation, units per second
    Vec3d angular_velocity{}; ///< rotation about the pose's translation, in world axes, radians per second
    std::string name{};       ///< name in error messages; if empty, "collider" and its index

    bool moves() const { return linear_velocity != Vec3d{} || angular_velocity != Vec3d{}; }
};

/// Velocity of the collider's material at a point, units per second.
Vec3d velocity_at(const Collider& collider, const Vec3d& point_world);

/// The pose after the given time at constant velocities, exact up to rounding, and bit-identical on every
/// system.
RigidTransform pose_after(const Collider& collider, double seconds);

/// Sets the velocities that move the collider to a pose in the given time, rotating along the shorter arc.
/// @param seconds  positive
void head_for(Collider& collider, const RigidTransform& pose, double seconds);

/// A keyframe: the pose of a collider at a time.
struct PoseKey {
    double time = 0; ///< seconds
    RigidTransform pose{};
};

/// The pose at a time. Between two keys the translation is interpolated linearly, and the rotation at
/// constant speed along the shorter arc (slerp: Shoemake 1985). Before the first key it is the pose of the
/// first key, and after the last key that of the last. The result is bit-identical on every system. The cost
/// grows with the logarithm of the number of keys.
/// @pre there is at least one key, times ascend, poses are finite and rotations have unit length
RigidTransform pose_at(std::span<const PoseKey> keys, double seconds);

/// The vertices of a model over time, in equally spaced samples, as in a PC2 file (mesh_io.hpp).
struct VertexCache {
    double start_time = 0;                             ///< the time of the first sample, seconds
    double sample_seconds = 1;                         ///< the time between samples; positive
    std::size_t vertex_count = 0;                      ///< the number of the model's vertices
    std::shared_ptr<const std::vector<Vec3f>> samples; ///< vertex_count positions each, local; at least one
    std::string name{}; ///< name in error messages, for instance the file's; may be empty

    std::size_t sample_count() const { return vertex_count > 0 ? samples->size() / vertex_count : 0; }
    double end_time() const { return start_time + sample_seconds * static_cast<double>(sample_count() - 1); }
};

/// The vertices at a time, interpolated linearly between samples. Before the first sample they are those of
/// the first, and after the last sample those of the last. @pre the cache has a sample
std::vector<Vec3f> vertices_at(const VertexCache& cache, double seconds);

// These queries behave like those of the map: they are noexcept, allocate only what the queries of the map
// allocate, and may run on any number of threads. A point is transformed to the local frame in double and
// rounded to float there, so a collider may be far from the origin as long as the caller's float positions
// resolve it. A point that overflows float in the local frame is outside. A point with NaN or infinity is
// outside and has no contact and no crossing. The cost is that of the map's query, plus that of converting
// the pose to a matrix, once per batch.
// @pre the pose is finite and its rotation has unit length, the factors of the scale are finite and not 0,
// and a custom map is not null. This is not checked: with a rotation that is not of unit length the answers
// are meaningless.

bool contains(const Collider& collider, Vec3f point_world) noexcept;

/// Finds the contact of a particle. If there is none, `point` equals the particle bit for bit.
///
/// With an exact map, the contact is the nearest point of the scaled surface in the world, with its distance
/// and the normal there. With a distance map, it is the point on the ray from the centre; depth and margin
/// are world lengths along that ray, and the normal is transformed by the inverse transpose of the scale.
/// Three equal factors cost nothing extra with either map. A custom map is queried with the margin divided by
/// the smallest factor, and its point and normal are scaled like those of a distance map; contacts beyond the
/// margin are passed on.
Contact contact(const Collider& collider, Vec3f point_world, float margin_world = 0) noexcept;

/// @param points_world  [n]
/// @param inside        [n] out: 1 inside, 0 outside. Must not overlap points_world.
/// @param thread_count  the number of threads for 32 768 points or more; 0: all cores. These threads then
/// also query a custom map concurrently
/// @pre points_world.size() == inside.size()
void contains_batch(const Collider& collider, StridedSpan<const Vec3f> points_world,
                    std::span<std::uint8_t> inside, unsigned thread_count = 1) noexcept;

/// @param points_world  [n]
/// @param contacts      [n] out. Must not overlap points_world.
/// @param thread_count  as in contains_batch()
/// @pre points_world.size() == contacts.size()
void contacts_batch(const Collider& collider, StridedSpan<const Vec3f> points_world, float margin_world,
                    std::span<Contact> contacts, unsigned thread_count = 1) noexcept;

/// The output of contacts_into(): the contacts that exist, one after the other, with a separate array for
/// each member. An empty array is not written, and one that is too short receives the first contacts. The
/// members are those of Contact.
/// @tparam T  float or double, the type of the points' coordinates
template <typename T>
struct ContactArrays {
    std::span<std::uint32_t> particles; ///< the index of the contact's point
    std::span<Vec3<T>> points{};
    std::span<Vec3f> normals{};
    std::span<float> depths{};
    std::span<std::uint32_t> faces{};
    std::span<std::uint8_t> inside{};     ///< 1 inside, 0 outside within the margin
    std::span<std::uint32_t> colliders{}; ///< the index of the contact's collider
};

/// Finds the contacts that contacts_batch() finds for one collider after the other, bit for bit, and leaves
/// out the points that have no contact. It suits solvers that keep separate arrays, have many points and few
/// contacts, or many colliders. Contacts ascend by collider, then by point. A collider whose bounding sphere
/// is away from all points costs next to nothing.
///
/// With points in double, the world may be arbitrarily large: points are rounded to float only in the
/// collider's local frame, and `points` of the contacts are the map's answers transformed to the world in
/// double. Normals, depths and faces then depend only on the relative position of points and collider.
/// @param points_world  [n]
/// @param contacts      out: arrays of any size; elements beyond the contacts are not changed. They must not
/// overlap points_world or each other
/// @returns the number of contacts, including those for which an array was too short
///
/// The function allocates only what the batches of the maps allocate and, from a thread's first call with a
/// custom map on, 200 KB that the thread keeps.
std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3f> points_world,
                          float margin_world, const ContactArrays<float>& contacts) noexcept;
std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3d> points_world,
                          float margin_world, const ContactArrays<double>& contacts) noexcept;

/// Finds where a moving particle first meets a collider that moves and rotates at the same time: the first
/// crossing of the chord between the particle's local positions in the previous and the present pose. If the
/// collider rotates by the angle a, the chord and the true path differ by at most a^2 / 8 of the distance
/// from the axis. The scale does not change during the motion.
///
/// `point` and `normal` are in the world, with the collider in its present pose: `point` is the present
/// position of the surface point that was met, or `to_world` without a crossing. `entering` is that of the
/// map's sweep. Distance maps and custom maps cannot be swept, so no crossing with them is found.
SweepHit sweep(const Collider& collider, const RigidTransform& previous_pose, Vec3f from_world,
               Vec3f to_world) noexcept;

/// sweep() for many particles.
/// @param from_world, to_world  [n]
/// @param hits                  [n] out. Must not overlap the points
/// @param thread_count          the number of threads for 32 768 particles or more; 0: all cores
/// @pre all three arrays have the same size
void sweep_batch(const Collider& collider, const RigidTransform& previous_pose,
                 StridedSpan<const Vec3f> from_world, StridedSpan<const Vec3f> to_world,
                 std::span<SweepHit> hits, unsigned thread_count = 1) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
