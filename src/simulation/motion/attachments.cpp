#include "simulation/motion/attachments.hpp"

#include "collider/frame_change.hpp"

#include <limits>

namespace echinus {

namespace {

/// The axes of a face: along its first edge, along its normal, and across.
struct FaceAxes {
    Vec3f along, up, across;

    explicit FaceAxes(const std::array<Vec3f, 3>& corners) {
        const Vec3f edge = corners[1] - corners[0];
        const Vec3f area = cross(edge, corners[2] - corners[0]);
        const float edge_length = length(edge), size = length(area);
        // A face without area has no axes.
        if (!(edge_length > 0) || !(size > 0)) return;
        along = edge * (1 / edge_length);
        up = area * (1 / size);
        across = cross(up, along);
    }
    Vec3f to_face(const Vec3f& v) const { return {dot(v, along), dot(v, up), dot(v, across)}; }
    Vec3f from_face(const Vec3f& v) const { return along * v.x + up * v.y + across * v.z; }
};

std::array<Vec3f, 3> corners_of(const Triangle& face, const SurfaceMotion& motion, float share) {
    std::array<Vec3f, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3f from = motion.from[face[k]];
        corners[k] = from + (motion.to[face[k]] - from) * share;
    }
    return corners;
}

Vec3f mean(const std::array<Vec3f, 3>& corners, const std::array<float, 3>& shares) {
    return corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2];
}

} // namespace

Attachments::Attachments(const Deformable& deformable, const std::vector<Collider>& colliders) {
    for (const auto& [particle, collider] : deformable.attachments)
        places_.push_back({particle, collider,
                           colliders[collider].pose.to_local(Vec3d(deformable.positions[particle])),
                           std::nullopt});
}

void Attachments::hold_on_to_surface(std::size_t collider, const Collider& now,
                                     const DeformingCollider& surface) {
    const FrameChange body(now.pose, {1, 1, 1});
    for (Place& place : places_) {
        if (place.collider != collider) continue;
        const Contact nearest =
            contact(now, Vec3f(now.pose.to_world(place.from_pose)), std::numeric_limits<float>::infinity());
        if (nearest.face == kNoIndex) continue;
        const Triangle face = surface.faces()[nearest.face];
        std::array<Vec3f, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] = Vec3f(times(Vec3d(surface.vertices()[face[k]]), now.scale));
        Hold hold{face, shares_in(corners, body.point_to_local(nearest.point)), {}};
        hold.aside = FaceAxes(corners).to_face(Vec3f(place.from_pose) - mean(corners, hold.shares));
        place.hold = hold;
    }
}

void Attachments::archive(StateArchive& state, std::span<const std::optional<DeformingCollider>> surfaces) {
    for (Place& place : places_)
        state.optional(place.hold, [&](Hold& hold) {
            const auto& surface = surfaces[place.collider];
            state.require(surface.has_value());
            for (std::uint32_t& vertex : hold.face)
                state.index(vertex, surface ? surface->vertices().size() : 0);
            state.value(hold.shares);
            state.value(hold.aside);
        });
}

void Attachments::follow(const std::vector<Collider>& colliders,
                         std::span<const std::optional<DeformingCollider>> surfaces, float share,
                         PointArrays& positions) const {
    for (const Place& place : places_) {
        const Collider& collider = colliders[place.collider];
        const DeformingCollider* surface = surfaces[place.collider] ? &*surfaces[place.collider] : nullptr;
        const SurfaceMotion* motion = surface != nullptr ? surface->motion() : nullptr;
        if (!collider.moves() && motion == nullptr) continue;
        Vec3d in_pose = place.from_pose;
        if (surface != nullptr && place.hold) {
            const auto corners = motion != nullptr ? corners_of(place.hold->face, *motion, share)
                                                   : surface->corners(place.hold->face, collider.scale);
            in_pose =
                Vec3d(mean(corners, place.hold->shares) + FaceAxes(corners).from_face(place.hold->aside));
        }
        positions.set(place.particle, Vec3f(collider.pose.to_world(in_pose)));
    }
}

} // namespace echinus
