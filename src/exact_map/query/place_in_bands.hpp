#pragma once

#include "directions/octahedral_cells.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/query/ray_crossing.hpp"

#include <cstdint>

namespace echinus {

/// Where a place of the lattice is among the bands of its cell.
struct PlaceInBands {
    std::uint32_t cell, part;
    std::int64_t t; ///< distance from the centre in units of ExactMapView::kBandUnit
    BandRange bands;
    std::uint32_t band; ///< the place is in it or in the gap below it; bands.last: beyond all

    bool is_beyond_all() const { return band == bands.last; }
    /// @pre !is_beyond_all()
    bool is_in_gap(const ExactMapView& map) const { return t < map.bands[band].lower; }
};

/// @param t  distance of the place from the centre
inline PlaceInBands place_in_bands(const ExactMapView& map, const OctahedralCells::Place& place,
                                   std::int64_t t) {
    PlaceInBands at{place.cell, place.part, t, bands_of_cell(map, place.cell), 0};
    at.band = at.bands.first;
    while (at.band < at.bands.last && t >= map.bands[at.band].upper) ++at.band;
    return at;
}

/// The winding number around a place, or kUncertain.
/// @param crossings  int crossings(RaySide, const PlaceInBands&): signed crossings of the place's ray with
/// the
///                   faces of its band
/// @pre !at.is_beyond_all()
template <typename Crossings>
int winding_in_bands(const ExactMapView& map, const PlaceInBands& at, const Crossings& crossings) {
    const bool in_gap = at.is_in_gap(map);
    const int winding = in_gap ? map.winding_below[at.band] : winding_beyond(map, at.band, at.bands);
    if (in_gap || winding == ExactMapView::kUncertain) return winding;
    if (winding == ExactMapView::kSplit) return map.winding_below[at.band] - crossings(RaySide::Before, at);
    return winding + crossings(RaySide::Beyond, at);
}

} // namespace echinus
