#pragma once

#include "exact_map/query/place_in_bands.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace echinus {

inline constexpr std::uint32_t kNoLeaf = UINT32_MAX;

/// A leaf of the face tree with a face near a place: a search that begins there soon has a good bound. The
/// face is one of the band that the place's ray from the centre meets nearest to it.
/// @returns kNoLeaf where the ray meets no band with faces
inline std::uint32_t leaf_near(const ExactMapView& map, const PlaceInBands& at) {
    const bool is_innermost = at.band == at.bands.first;
    const auto is_nearer_to_lower = [&] {
        return at.is_beyond_all() ||
               (at.is_in_gap(map) && at.t - map.bands[at.band - 1].upper < map.bands[at.band].lower - at.t);
    };
    if (is_innermost && at.is_beyond_all()) return kNoLeaf;
    const std::uint32_t band = at.band - (!is_innermost && is_nearer_to_lower() ? 1 : 0);
    const std::uint32_t first = map.bands[band].first_reference, last = map.bands[band + 1].first_reference;
    constexpr auto kFacesOfLeaf = static_cast<std::uint32_t>(TreeNode::kWidth);
    return first < last ? map.references[first + (last - first) / 2] / kFacesOfLeaf : kNoLeaf;
}

/// The same for any place.
/// @param place  finite
inline std::uint32_t leaf_near(const ExactMapView& map, const Vec3d& place) {
    constexpr auto kExtent = static_cast<double>(kLatticeExtent);
    const double largest = std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
    const bool on_lattice = largest <= kExtent;
    const LatticePoint p = rounded(on_lattice ? place : place * (kExtent / largest));
    const std::int64_t t = on_lattice ? band_unit_of(l1_norm(p)) : INT64_MAX;
    return leaf_near(map, place_in_bands(map, OctahedralCells(map.divisions).locate(p), t));
}

} // namespace echinus
