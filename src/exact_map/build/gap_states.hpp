#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A radial piece of a cell, in which the winding number has one value or none that is certain.
struct GapPiece {
    std::uint16_t upper;  ///< where it ends, in band units
    std::int16_t winding; ///< or ExactMapView::kUncertain
};

/// Finds where the generalised winding number of an open surface stays clear of halves, by kCertainMargin.
///
/// Between crossings it is a smooth function whose slope the border bounds, edge by edge, by length over
/// 4 pi distance^2 (the law of Biot and Savart: a solid angle is the potential of a current in its border).
/// So from its value at one place its range in a convex region follows, if no border edge comes near.
///
/// That takes time proportional to border edges times pieces. Work beyond a tenth of a second is skipped.
/// Where the border is long, as that of a triangle soup, next to nothing would be found: there all gaps stay
/// uncertain.
class GapStates {
  public:
    static constexpr int kMostHalvings = 5;

    /// @param most_halvings  how often a gap may be halved: it makes 2^most_halvings pieces at most
    GapStates(const LatticeMesh& lattice, std::span<const BorderEdge> border, const OctahedralCells& cells,
              int most_halvings = kMostHalvings);

    /// The pieces of a gap [lower, upper) of a cell, from below; neighbours differ.
    /// @param crossings  signed crossings beyond the gap on the ray through the cell's middle
    void append_pieces(std::uint32_t cell, std::int32_t lower, std::int32_t upper, int crossings,
                       std::vector<GapPiece>& pieces) const;

    /// Does the winding number within a band follow from that beyond it by counting crossings?
    /// @param crossings  beyond the band, on the ray through the cell's middle
    bool certain_in_band(std::uint32_t cell, std::int32_t lower, std::int32_t upper, int crossings) const;

  private:
    struct Edge {
        Vec3d a, b;
        double weight; ///< multiplicity times length over 4 pi
    };
    struct Region;

    std::int16_t winding_in(const Region& region, int crossings) const;
    void append_halves(std::uint32_t cell, std::int32_t lower, std::int32_t upper, int crossings, int depth,
                       std::vector<GapPiece>& pieces) const;
    /// How much the winding number can change within `reach` of a place; infinite where the border is near.
    double largest_change(const Vec3d& place, double reach) const;

    std::span<const BorderEdge> border_;
    OctahedralCells cells_;
    std::vector<Vec3<std::int32_t>> vertices_;
    std::vector<Edge> edges_;
    int max_depth_ =
        0; ///< how often a gap may be halved; negative when not even the first look can be afforded
};

} // namespace echinus
