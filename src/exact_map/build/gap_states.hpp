#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// A radial piece of a cell without faces, [lower, upper) in band units.
struct Gap {
    std::int32_t lower, upper;
    int crossings; ///< signed, beyond it, on the ray through the cell's middle
};

/// A piece of a gap, in which the winding number has one value or none that is certain.
struct GapPiece {
    std::uint16_t upper;  ///< where it ends, in band units
    std::int16_t winding; ///< or ExactMapView::kUncertain
};

/// Finds where the generalised winding number of an open surface stays clear of halves, by kCertainMargin.
///
/// Between crossings it is a smooth function whose slope the border bounds, edge by edge, by length over
/// 4 pi distance^2 (the law of Biot and Savart: a solid angle is the potential of a current in its border).
/// So from its value at one place, which is computed as queries do, its range in a convex region follows, if
/// no border edge comes near.
///
/// That takes time proportional to border edges times pieces, and work beyond a tenth of a second is skipped.
/// Where the border is long, as that of a triangle soup, next to nothing would be found: there all gaps stay
/// uncertain.
class GapStates {
  public:
    static constexpr int kMostHalvings = 5;
    static constexpr int kNone = -1; ///< all gaps stay uncertain

    /// @param surface        open, with its winding tree
    /// @param most_halvings  how often a gap may be halved, which makes 2^most_halvings pieces at most; or
    /// kNone
    GapStates(const ExactMapView& surface, const OctahedralCells& cells, int most_halvings = kMostHalvings);

    /// The pieces of a gap of a cell, from below; neighbours differ.
    void append_pieces(std::uint32_t cell, const Gap& gap, std::vector<GapPiece>& pieces) const;

    /// Does the winding number within a band follow from that below it by counting crossings?
    /// @param below  the gap that ends where the band begins
    /// @param upper  of the band
    bool certain_in_band(std::uint32_t cell, const Gap& below, std::int32_t upper) const;

  private:
    struct Edge {
        Vec3d a, b;
        double weight; ///< multiplicity times length over 4 pi
    };
    /// Edges near each other.
    struct Group {
        Vec3d centre;
        double radius, weight;
        std::size_t first, count;
    };
    static constexpr std::size_t kGroupSize = 8;
    struct Region;

    void put_neighbours_together();
    void make_groups();
    std::span<const Edge> edges_of(const Group& group) const;

    /// @param crossings  of faces beyond the place
    std::optional<double> winding_at(const LatticePoint& place, int crossings) const;
    /// @param gap  in which the region's place is to be
    std::int16_t winding_in(const Region& region, const Gap& gap) const;
    void append_halves(std::uint32_t cell, const Gap& gap, int depth, std::vector<GapPiece>& pieces) const;
    /// How much the winding number can change within `reach` of a place; infinite where the border is near.
    double largest_change(const Vec3d& place, double reach) const;

    ExactMapView surface_;
    OctahedralCells cells_;
    std::vector<Edge> edges_;
    std::vector<Group> groups_;
    int max_depth_; ///< how often a gap may be halved; negative when not even the first look can be afforded
};

} // namespace echinus
