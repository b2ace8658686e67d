#pragma once

#include "directions/checker.hpp"
#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Constants and conversions for the arrays of an exact map, for builds and queries.
namespace echinus {

// Cells are numbered in 32 bits, and in signed lanes of vectors; so are the products from which the numbers
// are computed.
static_assert(8 * std::uint64_t{ExactMapOptions::kMaxDivisions} * ExactMapOptions::kMaxDivisions < 1U << 31);

/// The far field of the triangles below each child of the TreeNode with the same index: the moments of their
/// area vectors about a centre, in lattice steps and divided by 4 pi. They give the winding number of an open
/// surface. For a child that does not exist, everything except the centre is 0.
/// exact_map/build/open_surface.hpp explains the moments.
struct WindingNode {
    static constexpr std::size_t kWidth = TreeNode::kWidth;

    double centre[3][kWidth];
    double area[3][kWidth];    ///< sum of the area vectors
    double first[6][kWidth];   ///< coefficients of x^2, y^2, z^2, xy, xz, yz
    double second[7][kWidth];  ///< coefficients of x (x^2 - 3 z^2), y (y^2 - 3 z^2), ... see open_surface.cpp
    double radius[kWidth];     ///< largest distance of a corner from the centre
    double spread[kWidth];     ///< integral of the squared distance from the centre
    double total_area[kWidth]; ///< sum of the areas
};
static_assert(sizeof(WindingNode) == 22 * 8 * sizeof(double));

/// A tree of the triangles whose solid angles a query of an open surface sums. They are the faces of the
/// surface, or caps that close it if these are far fewer (exact_map/query/winding.cpp).
struct WindingTree {
    std::span<const TreeNode> nodes;
    std::span<const WindingNode> moments; ///< [nodes.size()]
    IndexArray corners; ///< [3 triangle_count] vertices of each triangle, in the order of the leaves
    bool has_caps = false;
    /// At each border edge, two more faces run in one direction than in the other, as happens if neighbours
    /// disagree about the outside: the surface has no hole.
    bool neighbours_disagree = false;

    std::size_t triangle_count() const { return corners.size() / 3; }
};

/// Converts an L1 norm in lattice steps to the units of Band, rounding down.
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

/// The bands of a cell, as indices into ExactMapView::bands.
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

/// The winding number of the gap beyond a band of a cell, or kUncertain.
inline int winding_beyond(const ExactMapView& map, std::uint32_t band, const BandRange& bands) {
    return band + 1 < bands.last ? map.winding_below[band + 1] : 0;
}

inline bool is_inside(InsideRule rule, std::int64_t winding) {
    return rule == InsideRule::Nonzero ? winding != 0 : winding % 2 != 0;
}

/// Checks everything that queries rely on for safety, and whatever else can be checked in one pass: that the
/// sizes of bands, faces and tree agree, that no integer of a query overflows, that the tree is a tree and no
/// deeper than a query's stack, and that its boxes contain their faces. It does not check that the bands
/// match the faces; if they do not, answers are wrong. Takes at most about 2 % of the instructions of a
/// build.
/// @throws Error Damaged
void validate(const Checker& checker, const ExactMapView& map, const ExactMapStatistics& statistics);

/// The last step of a build.
/// @throws Error Damaged if the map contradicts itself, which is a fault of this library
ExactMap proven(const ExactMapView& map, const ExactMapStatistics& statistics, std::uint64_t source_hash,
                std::shared_ptr<const void> storage);

} // namespace echinus
