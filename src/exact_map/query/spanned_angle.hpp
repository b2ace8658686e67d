#pragma once

#include "geometry/angles.hpp"
#include "geometry/triangle.hpp"

namespace echinus {

/// The angle between two vectors.
inline float angle_between(const Vec3d& a, const Vec3d& b) {
    return atan2_polynomial(static_cast<float>(length(cross(a, b)) / (length(a) * length(b))),
                            static_cast<float>(dot(a, b) / (length(a) * length(b))));
}

/// The angle that a triangle spans around the origin: a full turn inside, half a turn on an edge, the
/// corner's angle at a corner. Edges and corners within `reach` count as met.
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
