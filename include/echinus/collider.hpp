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

/// A map placed in the world. Points, normals, depths and margins are in world units and world axes here.
namespace echinus {

/// The map of a collider, of either kind or the user's own. Each of them converts to it, and AnyMap does.
struct ColliderMap {
    using Kind = std::variant<DistanceMap, ExactMap, std::shared_ptr<const CustomMap>>;
    Kind kind;
    /// Beside a map that is not exact, the exact map of the same mesh, whose faces SimulationOptions::
    /// surface_collision needs: `kind` pushes particles out, and surfaces are kept from these faces. Queries
    /// do not ask it.
    std::optional<ExactMap> surface{};

    template <std::convertible_to<Kind> Map>
    ColliderMap(Map&& map) : kind(std::forward<Map>(map)) {}
    ColliderMap(const AnyMap& map) : kind(std::visit([](const auto& known) { return Kind(known); }, map)) {}
};

/// A rigid model in the world: its map, pose, scale and motion. A plain value; copies of a map share its
/// arrays, so copies are cheap.
///
/// point_world = pose.to_world(scale * (origin + point_local)), component by component. The origin is that of
/// the map (ExactMapView::origin), mostly 0; a simulation takes no other.
struct Collider {
    ColliderMap map;       ///< not a null pointer
    RigidTransform pose{}; ///< its rotation of unit length
    /// Along the map's axes. Three equal numbers change the size, different ones stretch the model, and a
    /// negative one mirrors it; what is inside stays inside, and normals point out of the solid. Not 0,
    /// finite.
    Vec3d scale{1, 1, 1};
    Vec3d linear_velocity{};  ///< of the pose's translation, units per second
    Vec3d angular_velocity{}; ///< about the pose's translation, world axes, radians per second
    std::string name{};       ///< for errors; if empty, "collider" and its number

    bool moves() const { return linear_velocity != Vec3d{} || angular_velocity != Vec3d{}; }
};

/// Velocity of the collider's material at a point, units per second.
Vec3d velocity_at(const Collider& collider, const Vec3d& point_world);

/// The pose a time later. Exact for constant velocities, to rounding; the same bits on every system.
RigidTransform pose_after(const Collider& collider, double seconds);

/// The velocities that lead the collider to a pose, the shorter way round.
/// @param seconds  positive
void head_for(Collider& collider, const RigidTransform& pose, double seconds);

/// Where a collider is at a time.
struct PoseKey {
    double time = 0; ///< seconds
    RigidTransform pose{};
};

/// The pose at a time. From key to key the translation goes straight and the rotation about one axis, the
/// shorter way round (slerp: Shoemake 1985), both evenly. Before the first key and after the last one the
/// pose is that key's. The same bits on every system. Cost: the logarithm of the number of keys.
/// @pre there is a key, times ascend, poses are finite and rotations of unit length
RigidTransform pose_at(std::span<const PoseKey> keys, double seconds);

/// The vertices of a model over time, in samples at equal distances, such as a PC2 file has (mesh_io.hpp).
struct VertexCache {
    double start_time = 0;                             ///< of the first sample, seconds
    double sample_seconds = 1;                         ///< from one sample to the next; positive
    std::size_t vertex_count = 0;                      ///< of the model
    std::shared_ptr<const std::vector<Vec3f>> samples; ///< vertex_count positions each, local; at least one
    std::string name{};                                ///< for errors, such as its file; may be empty

    std::size_t sample_count() const { return vertex_count > 0 ? samples->size() / vertex_count : 0; }
    double end_time() const { return start_time + sample_seconds * static_cast<double>(sample_count() - 1); }
};

/// The vertices at a time: straight and even from sample to sample; before the first and after the last they
/// rest. @pre the cache has a sample
std::vector<Vec3f> vertices_at(const VertexCache& cache, double seconds);

// Queries: as those of the map. noexcept, no allocation (but a custom map's own), any number of threads. A
// point is transformed to the local frame in double and rounded to float there, so a collider may stand far
// from the origin as long as the caller's float positions resolve it. A point that overflows float in the
// local frame is outside. NaN or infinity in a point: outside, no contact, no crossing. Cost per call: the
// map's query, and the conversion of the pose to a matrix, once per batch.
// @pre the pose is finite and its rotation of unit length, scale is finite and has no 0, and a custom map is
// not null. Nothing checks this here: with another rotation the answers are not meaningful.

bool contains(const Collider& collider, Vec3f point_world) noexcept;

/// Where nothing is found, `point` equals the particle bit for bit.
///
/// An exact map gives the point of the scaled surface that is nearest in the world, its distance and the
/// normal of the scaled surface. A distance map gives the point on the ray from the centre, as always; depth
/// and margin are world lengths along that ray, and the normal is transformed by the inverse transpose of the
/// scale. Three equal scales cost nothing extra with either map. A custom map is asked with the margin
/// divided by the smallest scale, and its point and normal are scaled like a distance map's; contacts that it
/// gives beyond the margin are passed on.
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

/// Where contacts_into() writes: the contacts alone, one after the other, each member an array of its own. An
/// empty array is not wanted, and one that is too short takes the first contacts. Members as in Contact.
/// @tparam T  float or double, as the positions of the points
template <typename T>
struct ContactArrays {
    std::span<std::uint32_t> particles; ///< the contact's point, by its number
    std::span<Vec3<T>> points{};
    std::span<Vec3f> normals{};
    std::span<float> depths{};
    std::span<std::int32_t> faces{};
    std::span<std::uint8_t> inside{};     ///< 1 inside, 0 outside within the margin
    std::span<std::uint32_t> colliders{}; ///< the contact's collider, by its number
};

/// The contacts that contacts_batch() finds beside one collider after the other, bit for bit, without the
/// points that have none: for solvers that keep separate arrays, have many points and few contacts, or many
/// colliders. Ascending by collider, then by point. A collider whose bounding sphere is away from all points
/// costs nothing more.
///
/// With points in double, a world may be as large as one likes: points are rounded to float only in a
/// collider's local frame, and `points` of the contacts are the map's answer taken to the world in double.
/// Then normals, depths and faces are the same wherever points and collider stand together.
/// @param points_world  [n]
/// @param contacts      out: arrays of any size; beyond the contacts they are left as they are. No overlap
///                      with points_world or each other
/// @returns how many contacts there are, also those that an array was too short for
/// Allocates nothing beyond what batches of the maps do. Takes 170 KB of the stack, and with a custom map 350
/// KB.
std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3f> points_world,
                          float margin_world, const ContactArrays<float>& contacts) noexcept;
std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3d> points_world,
                          float margin_world, const ContactArrays<double>& contacts) noexcept;

/// Where a particle first meets a collider that moves and turns while the particle moves: the first crossing
/// of the chord between the particle's local position under the previous pose and the one under the present
/// pose. Over a frame in which the collider turns by the angle a, chord and true path differ by at most a^2 /
/// 8 of the distance from the axis. The scale is the same at both ends.
///
/// `point` and `normal` are in the world, with the collider in its present pose: `point` is where the point
/// of the surface that was met lies now, and `to_world` when nothing is met. `entering` is as the map has it.
/// Distance maps and custom maps have no sweep: with them, nothing is met.
SweepHit sweep(const Collider& collider, const RigidTransform& previous_pose, Vec3f from_world,
               Vec3f to_world) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
