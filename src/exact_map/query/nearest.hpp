#pragma once

#include "directions/lattice.hpp"

#include <echinus/contact.hpp>
#include <echinus/exact_map_view.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

/// Nearest points of an exact map's surface. Places are in lattice steps from the centre, and distances those
/// of space stretched along the axes (see contact()).
namespace echinus {

struct NearestPoint {
    Vec3d point;
    double distance = 0; ///< of the stretched
    std::uint32_t face = 0;
    Feature feature = Feature::Unknown;
};

/// Is a place clear of the lattice? The farther it is, the less squared distances to different faces differ,
/// and the search compares them in another form.
inline constexpr double kAfar = 1.25 * static_cast<double>(kLatticeExtent);
inline bool is_afar(const Vec3d& place) {
    return std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)}) >= kAfar;
}

/// Where a place is so far that the distances to the faces, rounded to double, no longer differ, the place
/// from which the nearest face and its nearest point are found instead: on its ray from the centre, and so
/// far that both are the same but for a sixteenth of a lattice step, stretched.
inline Vec3d brought_within_reach(const Vec3d& place, const Vec3d& stretch = {1, 1, 1}) {
    constexpr double kReach = 0x1p44;
    const double largest = std::max(
        {std::fabs(place.x * stretch.x), std::fabs(place.y * stretch.y), std::fabs(place.z * stretch.z)});
    return largest > kReach ? place * (kReach / largest) : place;
}

/// The nearest face of the whole surface, if it is at most `farthest` away: a branch and bound search of the
/// face tree, so that the minimum is global. Of faces that are equally near, the first.
std::optional<std::uint32_t> nearest_face(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch,
                                          double farthest) noexcept;

/// The nearest point of one face.
NearestPoint nearest_point_on_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                                   const Vec3d& stretch) noexcept;

/// The squared distance by which nearest_face() compares faces.
double distance_sq_to_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                           const Vec3d& stretch) noexcept;

/// Unit normal of the stretched surface at its nearest point: the sum of the normals of the faces within
/// `reach` lattice steps of it, each weighed by the angle that the face spans there (a full turn inside a
/// face, half a turn on its edge). Baerentzen and Aanaes 2005. Where they cancel, as on a plate without
/// thickness, that of the nearest face; 0, 0, 1 where that has no area.
Vec3f pseudonormal(const ExactMapView& map, const NearestPoint& nearest, const Vec3d& stretch,
                   double reach) noexcept;

} // namespace echinus
