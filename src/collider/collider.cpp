#include "collider/frame_change.hpp"
#include "collider/queries_in_frame.hpp"
#include "geometry/box.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"
#include "geometry/scratch.hpp"

#include <echinus/collider.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <type_traits>
#include <variant>

namespace echinus {

namespace {

/// The box around the finite points in the world; other points have no contacts.
template <typename T>
AlignedBox<double> box_around(const StridedSpan<const Vec3<T>>& points) {
    AlignedBox<double> box;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const Vec3d p(points[i]); is_finite(p)) box.add(p);
    return box;
}

/// The ball around a map's surface, outside which nothing is inside. There is none for custom maps, nor for
/// open surfaces, whose winding numbers may have any value anywhere.
std::optional<Sphere> ball_around(const ExactMap& map) {
    if (!map.view().border.empty()) return {};
    return Sphere{Vec3d(map.view().centre), map.view().radius};
}
std::optional<Sphere> ball_around(const DistanceMap& map) {
    return Sphere{Vec3d(map.view().centre), map.view().radius};
}
std::optional<Sphere> ball_around(const std::shared_ptr<const CustomMap>&) {
    return {};
}

/// Returns false only if contacts_batch() would find nothing.
bool may_touch(const Collider& collider, const AlignedBox<double>& points, float margin_world) {
    const auto local = std::visit([](const auto& map) { return ball_around(map); }, collider.map.kind);
    if (!local) return true;
    // Points are rounded to floats relative to the map's origin; its centre is rounded to doubles relative to
    // the world's origin.
    constexpr double kFloats = 1e-6, kDoubles = 1e-14;
    const Vec3d &s = collider.scale, origin = origin_of(collider.map);
    const double size = std::max({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)});
    const double rounding = kFloats * size * (length(local->centre) + local->radius) +
                            kDoubles * (length(collider.pose.translation) + size * length(origin));
    const double reach = size * local->radius + std::max(0.0F, margin_world) * (1 + kFloats) + rounding;
    return !(points.distance(collider.pose.to_world(times(local->centre + origin, s))) > reach);
}

template <typename T>
struct OnStack {
    T object;

    T& operator*() { return object; }
};

/// The pieces for custom maps are too large for a small stack.
template <typename T>
using PieceMemory = std::conditional_t<sizeof(T) <= 10'000, OnStack<T>, OnScratch<T>>;

/// Calls `body(begin, points_local)` for consecutive pieces of a batch.
template <std::size_t piece_size, typename T, typename Body>
void for_each_piece(const FrameChange& frame, const StridedSpan<const Vec3<T>>& points_world,
                    const Body& body) {
    PieceMemory<std::array<Vec3f, piece_size>> memory;
    std::array<Vec3f, piece_size>& points_local = *memory;
    for (std::size_t begin = 0; begin < points_world.size(); begin += piece_size) {
        const std::size_t count = std::min(piece_size, points_world.size() - begin);
        for (std::size_t i = 0; i < count; ++i)
            points_local[i] = frame.point_to_local(points_world[begin + i]);
        body(begin, std::span<const Vec3f>(points_local.data(), count));
    }
}

/// Calls `body` with the queries for the collider's kind of map.
template <typename Body>
auto with_queries(const Collider& collider, const FrameChange& frame, float margin_world, const Body& body) {
    return std::visit([&](const auto& map) { return body(queries(frame, map, margin_world)); },
                      collider.map.kind);
}

/// @param point  the point of the contact, in the precision of the world
template <typename T>
void write(const Contact& contact, const Vec3<T>& point, std::size_t particle, std::size_t collider,
           std::size_t at, const ContactArrays<T>& arrays) {
    const auto put = [at](const auto& array, const auto& value) {
        if (at < array.size()) array[at] = value;
    };
    put(arrays.particles, static_cast<std::uint32_t>(particle));
    put(arrays.points, point);
    put(arrays.normals, contact.normal);
    put(arrays.depths, contact.depth);
    put(arrays.faces, contact.face);
    put(arrays.inside, static_cast<std::uint8_t>(contact.inside ? 1 : 0));
    put(arrays.colliders, static_cast<std::uint32_t>(collider));
}

/// Appends the contacts of one collider. @param count  in: the contacts of previous colliders; out: including
/// its own
template <typename T>
void append_contacts(const Collider& collider, std::size_t number, const StridedSpan<const Vec3<T>>& points,
                     float margin, const ContactArrays<T>& contacts, std::size_t& count) {
    const FrameChange frame(collider);
    with_queries(collider, frame, margin, [&]<typename Queries>(const Queries& queries) {
        PieceMemory<std::array<Contact, Queries::kPieceSize>> memory;
        std::array<Contact, Queries::kPieceSize>& found = *memory;
        for_each_piece<Queries::kPieceSize>(frame, points, [&](std::size_t begin, auto points_local) {
            queries.ask_contacts(points_local, std::span(found.data(), points_local.size()));
            for (std::size_t i = 0; i < points_local.size(); ++i) {
                const Vec3f on_surface = found[i].point;
                queries.to_world(found[i], points_local[i], Vec3f(points[begin + i]));
                if (found[i].found())
                    write(found[i], frame.point_to_world<T>(on_surface), begin + i, number, count++,
                          contacts);
            }
        });
    });
}

template <typename T>
std::size_t gather_contacts(std::span<const Collider> colliders, const StridedSpan<const Vec3<T>>& points,
                            float margin, const ContactArrays<T>& contacts) {
    std::optional<AlignedBox<double>> box; // with one collider, computing the box costs more than it saves
    if (colliders.size() > 1) box = box_around(points);
    std::size_t count = 0;
    for (std::size_t k = 0; k < colliders.size(); ++k)
        if (!box || may_touch(colliders[k], *box, margin))
            append_contacts(colliders[k], k, points, margin, contacts, count);
    return count;
}

} // namespace

bool contains(const Collider& collider, Vec3f point_world) noexcept {
    const FrameChange frame(collider);
    return with_queries(collider, frame, 0, [&](const auto& queries) {
        return queries.ask_contains(frame.point_to_local(point_world));
    });
}

Contact contact(const Collider& collider, Vec3f point_world, float margin_world) noexcept {
    const FrameChange frame(collider);
    const Vec3f point_local = frame.point_to_local(point_world);
    return with_queries(collider, frame, margin_world, [&](const auto& queries) {
        Contact found = queries.ask_contact(point_local);
        queries.to_world(found, point_local, point_world);
        return found;
    });
}

void contains_batch(const Collider& collider, StridedSpan<const Vec3f> points_world,
                    std::span<std::uint8_t> inside, unsigned thread_count) noexcept {
    if (!is_met(points_world.size() == inside.size(),
                "contains_batch: the number of answers differs from the number of points"))
        return;
    const FrameChange frame(collider);
    for_each_piece(inside.size(), thread_count, [&](std::size_t first, std::size_t end) {
        const StridedSpan<const Vec3f> points = points_world.subspan(first, end - first);
        with_queries(collider, frame, 0, [&]<typename Queries>(const Queries& queries) {
            for_each_piece<Queries::kPieceSize>(frame, points, [&](std::size_t begin, auto points_local) {
                queries.ask_contains(points_local, inside.subspan(first + begin, points_local.size()));
            });
        });
    });
}

void contacts_batch(const Collider& collider, StridedSpan<const Vec3f> points_world, float margin_world,
                    std::span<Contact> contacts, unsigned thread_count) noexcept {
    if (!is_met(points_world.size() == contacts.size(),
                "contacts_batch: the number of contacts differs from the number of points"))
        return;
    const FrameChange frame(collider);
    for_each_piece(contacts.size(), thread_count, [&](std::size_t first, std::size_t end) {
        const StridedSpan<const Vec3f> points = points_world.subspan(first, end - first);
        with_queries(collider, frame, margin_world, [&]<typename Queries>(const Queries& queries) {
            for_each_piece<Queries::kPieceSize>(frame, points, [&](std::size_t begin, auto points_local) {
                const std::span<Contact> piece = contacts.subspan(first + begin, points_local.size());
                queries.ask_contacts(points_local, piece);
                for (std::size_t i = 0; i < piece.size(); ++i)
                    queries.to_world(piece[i], points_local[i], points[begin + i]);
            });
        });
    });
}

std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3f> points_world,
                          float margin_world, const ContactArrays<float>& contacts) noexcept {
    return gather_contacts(colliders, points_world, margin_world, contacts);
}

std::size_t contacts_into(std::span<const Collider> colliders, StridedSpan<const Vec3d> points_world,
                          float margin_world, const ContactArrays<double>& contacts) noexcept {
    return gather_contacts(colliders, points_world, margin_world, contacts);
}

SweepHit sweep(const Collider& collider, const RigidTransform& previous_pose, Vec3f from_world,
               Vec3f to_world) noexcept {
    SweepHit hit;
    hit.point = to_world;
    const auto* exact = std::get_if<ExactMap>(&collider.map.kind);
    if (exact == nullptr) return hit;
    const FrameChange frame(collider);
    const Vec3f from_local = FrameChange(collider, previous_pose).point_to_local(from_world);
    const SweepHit met = sweep(exact->view(), from_local, frame.point_to_local(to_world));
    if (!met.found()) return hit;
    hit = met;
    hit.point = frame.point_to_world(met.point);
    hit.normal = frame.normal_to_world(frame.scaled_normal(met.normal));
    return hit;
}

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

void sweep_batch(const Collider& collider, const RigidTransform& previous_pose,
                 StridedSpan<const Vec3f> from_world, StridedSpan<const Vec3f> to_world,
                 std::span<SweepHit> hits, unsigned thread_count) noexcept {
    if (!is_met(from_world.size() == hits.size() && to_world.size() == hits.size(),
                "sweep_batch: starts, ends and hits differ in number"))
        return;
    answer_each(hits, thread_count,
                [&](std::size_t i) { return sweep(collider, previous_pose, from_world[i], to_world[i]); });
}

} // namespace echinus
