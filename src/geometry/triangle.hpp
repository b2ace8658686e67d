#pragma once

#include "geometry/elementary.hpp"

#include <echinus/contact.hpp>
#include <echinus/geometry.hpp>

#include <array>
#include <cstddef>
#include <limits>

namespace echinus {

// The points of a segment and of a triangle that are nearest to the origin. Segments may be points, and
// triangles may have no area.

using TriangleCorners = std::array<Vec3d, 3>;

inline double clamp01(double value) {
    return value < 0 ? 0 : value > 1 ? 1 : value;
}

/// The point of a segment that is nearest to the origin, as a fraction of the segment from a to b.
inline double nearest_share(const Vec3d& a, const Vec3d& ab) {
    const double length_sq = dot(ab, ab);
    return length_sq > 0 ? clamp01(-dot(a, ab) / length_sq) : 0;
}

struct NearestOnTriangle {
    Vec3d point;
    double distance = 0;
    Feature feature = Feature::Unknown;
};

/// The point of a triangle that is nearest to the origin, and the part of the triangle that contains it.
inline NearestOnTriangle nearest_on_triangle(const TriangleCorners& corners) {
    const auto& [a, b, c] = corners;
    const Vec3d normal = cross(b - a, c - b);
    NearestOnTriangle nearest;
    double nearest_sq = std::numeric_limits<double>::infinity();
    bool above = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d& start = corners[k];
        const Vec3d edge = corners[(k + 1) % 3] - start;
        above = above && dot(cross(normal, start), edge) > 0;
        const double share = nearest_share(start, edge);
        const Vec3d candidate = start + edge * share;
        const double distance_sq = dot(candidate, candidate);
        if (!(distance_sq < nearest_sq)) continue;
        nearest_sq = distance_sq;
        nearest.point = candidate;
        nearest.feature = share > 0 && share < 1 ? Feature::Edge : Feature::Vertex;
    }
    if (above) {
        nearest.point = normal * (dot(a, normal) / dot(normal, normal));
        nearest.feature = Feature::Face;
    }
    nearest.distance = length(nearest.point);
    return nearest;
}

/// The angle between two vectors.
inline float angle_between(const Vec3d& a, const Vec3d& b) {
    return atan2_polynomial(static_cast<float>(length(cross(a, b)) / (length(a) * length(b))),
                            static_cast<float>(dot(a, b) / (length(a) * length(b))));
}

/// The angle that a triangle spans around the origin, which must lie on it: 2 pi in the interior, pi on an
/// edge, and at a corner the angle of that corner. Edges and corners within `reach` of the origin count as
/// containing it.
inline float spanned_angle(const TriangleCorners& corners, double reach) {
    for (std::size_t k = 0; k < 3; ++k)
        if (length(corners[k]) <= reach)
            return angle_between(corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d edge = corners[(k + 1) % 3] - corners[k];
        if (length(corners[k] + edge * nearest_share(corners[k], edge)) <= reach) return kPi;
    }
    return 2 * kPi;
}

} // namespace echinus
