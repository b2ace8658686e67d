#pragma once

#include "directions/octahedral_cells.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/query/ray_crossing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace echinus {

/// The position of a lattice point among the bands of its cell.
struct PlaceInBands {
    std::uint32_t cell, part;
    std::int64_t t; ///< distance from the centre in units of ExactMapView::kBandUnit
    BandRange bands;
    std::uint32_t band; ///< the place is in this band or in the gap below it; bands.last if beyond all

    bool is_beyond_all() const { return band == bands.last; }
    /// @pre !is_beyond_all()
    bool is_in_gap(const ExactMapView& map) const { return t < map.bands[band].lower; }
};

/// @param t  L1 distance of the place from the centre, in units of ExactMapView::kBandUnit
inline PlaceInBands place_in_bands(const ExactMapView& map, const OctahedralCells::Place& place,
                                   std::int64_t t) {
    PlaceInBands at{place.cell, place.part, t, bands_of_cell(map, place.cell), 0};
    at.band = at.bands.first;
    while (at.band < at.bands.last && t >= map.bands[at.band].upper) ++at.band;
    return at;
}

/// The winding number around a place, or kUncertain.
/// @param crossings  int crossings(RaySide, const PlaceInBands&): the signed crossings of the place's ray
///                   with the faces of its band
/// @pre !at.is_beyond_all()
template <typename Crossings>
int winding_in_bands(const ExactMapView& map, const PlaceInBands& at, const Crossings& crossings) {
    const bool in_gap = at.is_in_gap(map);
    const int winding = in_gap ? map.winding_below[at.band] : winding_beyond(map, at.band, at.bands);
    if (in_gap || winding == ExactMapView::kUncertain) return winding;
    if (winding == ExactMapView::kSplit) return map.winding_below[at.band] - crossings(RaySide::Before, at);
    return winding + crossings(RaySide::Beyond, at);
}

inline constexpr std::uint32_t kNoLeaf = UINT32_MAX;

/// A leaf of the face tree with a face near a place, so that a search that begins there soon has a good
/// bound. The face is from the band nearest to the place on its ray from the centre.
/// @returns kNoLeaf if that band has no faces, or there is none
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

/// The same for any place, also beyond the lattice.
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
