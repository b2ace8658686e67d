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

/// Contacts of a distance map, to the world in place: most particles have no contact, and copying their
/// answers would take longer than this.
class RadialContacts {
  public:
    RadialContacts(const FrameChange& frame, const DistanceMap& map, float margin_world)
        : frame_(frame), map_(map), margin_world_(margin_world) {}

    /// Along no ray is a world length longer in the local frame.
    float margin_local() const { return static_cast<float>(margin_world_ / frame_.least_scale()); }

    void to_world(Contact& contact, const Vec3f& point_local, const Vec3f& point_world) const {
        if (contact.found() && !frame_.uniform()) stretch(contact, point_local);
        if (!contact.found()) {
            contact.point = point_world;
            return;
        }
        contact.point = frame_.point_to_world(contact.point);
        contact.normal = frame_.normal_to_world(contact.normal);
        if (frame_.uniform()) contact.depth = static_cast<float>(contact.depth * frame_.least_scale());
    }

  private:
    /// Depth along the ray, and the normal. What lies within the widest local margin may be beyond the
    /// world's.
    void stretch(Contact& contact, const Vec3f& point_local) const {
        const Vec3d from_centre = Vec3d(point_local) - Vec3d(map_.view().centre);
        const Vec3d ray = from_centre == Vec3d{} ? Vec3d(contact.point) - Vec3d(point_local) : from_centre;
        contact.depth = static_cast<float>(contact.depth * frame_.stretch_along(ray));
        contact.normal = frame_.scaled_normal(contact.normal);
        if (!contact.inside && -contact.depth > margin_world_) contact = {};
    }

    const FrameChange& frame_;
    const DistanceMap& map_;
    float margin_world_;
};

/// Contacts of an exact map, which knows the stretch itself: only the pose is left to do.
void exact_to_world(const FrameChange& frame, Contact& contact, const Vec3f& point_world) {
    if (!contact.found()) {
        contact.point = point_world;
        return;
    }
    contact.point = frame.point_to_world(contact.point);
    contact.normal = frame.normal_to_world(contact.normal);
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
    const Vec3f point_local = frame.point_to_local(point_world);
    Contact found;
    if (const auto* exact = std::get_if<ExactMap>(&collider.map)) {
        found = contact(exact->view(), point_local, margin_world, frame.scale());
        exact_to_world(frame, found, point_world);
    } else {
        const auto& map = *std::get_if<DistanceMap>(&collider.map);
        const RadialContacts radial(frame, map, margin_world);
        found = contact(map.view(), point_local, radial.margin_local());
        radial.to_world(found, point_local, point_world);
    }
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
    if (const auto* exact = std::get_if<ExactMap>(&collider.map)) {
        for_each_piece(frame, points_world, [&](std::size_t begin, std::span<const Vec3f> points_local) {
            const std::span<Contact> piece = contacts.subspan(begin, points_local.size());
            contacts_batch(exact->view(), points_local, margin_world, piece, frame.scale());
            for (std::size_t i = 0; i < piece.size(); ++i)
                exact_to_world(frame, piece[i], points_world[begin + i]);
        });
        return;
    }
    const auto& map = *std::get_if<DistanceMap>(&collider.map);
    const RadialContacts radial(frame, map, margin_world);
    for_each_piece(frame, points_world, [&](std::size_t begin, std::span<const Vec3f> points_local) {
        const std::span<Contact> piece = contacts.subspan(begin, points_local.size());
        contacts_batch(map.view(), points_local, radial.margin_local(), piece);
        for (std::size_t i = 0; i < piece.size(); ++i)
            radial.to_world(piece[i], points_local[i], points_world[begin + i]);
    });
}

SweepHit sweep(const Collider& collider, const RigidTransform& previous_pose, Vec3f from_world,
               Vec3f to_world) noexcept {
    SweepHit hit;
    hit.point = to_world;
    const auto* exact = std::get_if<ExactMap>(&collider.map);
    if (exact == nullptr) return hit;
    const FrameChange frame(collider);
    const Vec3f from_local = FrameChange(previous_pose, collider.scale).point_to_local(from_world);
    const SweepHit met = sweep(exact->view(), from_local, frame.point_to_local(to_world));
    if (!met.found()) return hit;
    hit = met;
    hit.point = frame.point_to_world(met.point);
    hit.normal = frame.normal_to_world(frame.scaled_normal(met.normal));
    return hit;
}

} // namespace echinus
