#pragma once

#include "exact_map/query/near_leaf.hpp"

#include <echinus/exact_map_view.hpp>

#include <cstdint>
#include <span>

/// nearest_face() for many places.
namespace echinus {

struct NearestSearch {
    Vec3d place;                       ///< in lattice steps
    double farthest;                   ///< as nearest_face() takes it
    std::uint32_t near_leaf = kNoLeaf; ///< leaf_near(), or not yet known
};

inline constexpr std::uint32_t kNoFace = UINT32_MAX;

/// The nearest face of a place, or kNoFace; the same as that of nearest_face(), whatever the instruction set.
/// It needs no places near each other: a node's boxes and a leaf's faces are the lanes.
/// @param search  finite
std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch,
                                const NearestSearch& search) noexcept;

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
