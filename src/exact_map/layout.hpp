#pragma once

#include "directions/checker.hpp"
#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// Constants and conversions for an exact map's arrays that the build and the queries share.
namespace echinus {

// Cells are numbered in 32 bits, with a sign in vectors, and so are the products that number them.
static_assert(8 * std::uint64_t{ExactMapOptions::kMaxDivisions} * ExactMapOptions::kMaxDivisions < 1U << 31);

/// Lattice steps of the L1 norm to the units of Band, rounded down.
inline std::int64_t band_unit_of(std::int64_t l1) {
    return l1 / ExactMapView::kBandUnit;
}

inline LatticeFrame frame_of(const ExactMapView& map) {
    return {map.centre, map.radius};
}

inline std::array<LatticePoint, 3> face_corners(const ExactMapView& map, std::uint32_t face) {
    const auto corner = [&](std::size_t k) {
        return LatticePoint(map.vertices[map.corners[3 * std::size_t{face} + k]]);
    };
    return {corner(0), corner(1), corner(2)};
}

/// The bands of a cell, as numbers of ExactMapView::bands.
struct BandRange {
    std::uint32_t first, last; ///< half open
};

inline BandRange bands_of_cell(const ExactMapView& map, std::uint32_t cell) {
    return {map.band_offsets[cell], map.band_offsets[cell + 1]};
}

/// Sets ExactMapView::outer_limits.
inline void set_outer_limits(std::span<const std::uint32_t> band_offsets, std::span<const Band> bands,
                             std::vector<std::uint16_t>& outer_limits) {
    outer_limits.resize(band_offsets.size() - 1);
    for (std::size_t cell = 0; cell < outer_limits.size(); ++cell) {
        const std::uint32_t end = band_offsets[cell + 1];
        outer_limits[cell] = end > band_offsets[cell] ? bands[end - 1].upper : std::uint16_t{0};
    }
}

/// Winding number of the gap beyond a band of a cell, or kUncertain.
inline int winding_beyond(const ExactMapView& map, std::uint32_t band, const BandRange& bands) {
    return band + 1 < bands.last ? map.winding_below[band + 1] : 0;
}

inline bool is_inside(InsideRule rule, std::int64_t winding) {
    return rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
}

/// Checks everything that keeps queries harmless, and what else one pass can check: bands, faces and tree
/// agree in their numbers, no integer of a query overflows, the tree is a tree and no deeper than a query's
/// stack, its boxes contain their faces. It does not check that the bands match the faces; where they do not,
/// answers are wrong. Takes at most some 2 % of the instructions of a build.
/// @throws Error Damaged
void validate(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics);

/// The last step of a build.
/// @throws Error Damaged where the map contradicts itself, through a fault of this library
ExactMap proven(const ExactMapView& map, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                std::shared_ptr<const void> storage);

} // namespace echinus
