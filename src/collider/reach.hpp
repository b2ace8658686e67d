#pragma once

#include "collider/frame_change.hpp"
#include "geometry/box.hpp"

#include <echinus/collider.hpp>

#include <algorithm>
#include <optional>
#include <variant>

/// Which colliders have no contact with any point of a batch, at the price of a bounding box.
namespace echinus {

/// Around the finite points, in the world; the others have no contact anyway.
template <typename T>
AlignedBox<double> box_around(const StridedSpan<const Vec3<T>>& points) {
    AlignedBox<double> box;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (const Vec3d p(points[i]); is_finite(p)) box.add(p);
    return box;
}

/// The ball around a map's surface, beyond which nothing is inside. There is none around a map of the user's
/// own, nor around an open surface, whose winding number may be anything anywhere.
inline std::optional<Sphere> ball_around(const ExactMap& map) {
    if (!map.view().border.empty()) return {};
    return Sphere{Vec3d(map.view().centre), map.view().radius};
}
inline std::optional<Sphere> ball_around(const DistanceMap& map) {
    return Sphere{Vec3d(map.view().centre), map.view().radius};
}
inline std::optional<Sphere> ball_around(const std::shared_ptr<const CustomMap>&) {
    return {};
}

/// False only where contacts_batch() finds nothing.
inline bool may_touch(const Collider& collider, const AlignedBox<double>& points, float margin_world) {
    const auto local = std::visit([](const auto& map) { return ball_around(map); }, collider.map.kind);
    if (!local) return true;
    // Points are rounded to floats around the map's origin, its centre to doubles around the world's.
    constexpr double kFloats = 1e-6, kDoubles = 1e-14;
    const Vec3d &s = collider.scale, origin = origin_of(collider.map);
    const double size = std::max({std::fabs(s.x), std::fabs(s.y), std::fabs(s.z)});
    const double rounding = kFloats * size * (length(local->centre) + local->radius) +
                            kDoubles * (length(collider.pose.translation) + size * length(origin));
    const double reach = size * local->radius + std::max(0.0F, margin_world) * (1 + kFloats) + rounding;
    return !(points.distance(collider.pose.to_world(times(local->centre + origin, s))) > reach);
}

} // namespace echinus
