#pragma once

#include <echinus/exact_map_view.hpp>

#include <cstdint>
#include <span>

/// nearest_face() for many places.
namespace echinus {

struct NearestSearch {
    Vec3d place;     ///< in lattice steps
    double farthest; ///< as nearest_face() takes it
};

inline constexpr std::uint32_t kNoFace = UINT32_MAX;

/// The nearest face of each place, or kNoFace; the same as that of nearest_face(), whatever the instruction
/// set.
///
/// As many places as there are lanes go down the tree together. A filter in single precision leaves each of
/// them few faces, mostly one; among several the distances of the reference decide.
/// @param searches  places near each other should follow each other; finite
/// @pre searches.size() == faces.size()
void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) noexcept;

} // namespace echinus
