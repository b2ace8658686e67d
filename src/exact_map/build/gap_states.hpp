#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace echinus {

/// A radial piece of a cell that contains no faces, [lower, upper) in band units.
struct Gap {
    std::int32_t lower, upper;
    int crossings; ///< signed crossings beyond the gap on the ray through the cell's middle
};

/// A piece of a gap, in which the winding number has one certain value or none.
struct GapPiece {
    std::uint16_t upper;  ///< upper end, in band units
    std::int16_t winding; ///< or ExactMapView::kUncertain
};

/// Finds where the generalised winding number of an open surface stays away from halves by kCertainMargin.
///
/// Between crossings it is a smooth function. The border bounds its slope: each edge contributes its length
/// over 4 pi distance^2 (the law of Biot and Savart: a solid angle is the potential of a current along its
/// border). So its value at one point, computed as by queries, determines its range in a convex region,
/// provided that no border edge comes near.
///
/// The time is proportional to border edges times pieces, and work beyond a tenth of a second is skipped. If
/// the border is long, as that of a triangle soup, hardly any gap would be certain; then all gaps stay
/// uncertain.
class GapStates {
  public:
    static constexpr int kMostHalvings = 5;
    static constexpr int kNone = -1; ///< all gaps stay uncertain

    /// @param surface        open, with its winding tree
    /// @param most_halvings  how often a gap may be halved, into at most 2^most_halvings pieces; or kNone
    GapStates(const ExactMapView& surface, const OctahedralCells& cells, int most_halvings = kMostHalvings);

    /// Appends the pieces of a gap of a cell, from below; neighbouring pieces differ.
    void append_pieces(std::uint32_t cell, const Gap& gap, std::vector<GapPiece>& pieces) const;

    /// Does the winding number within a band follow from that below it by counting crossings?
    /// @param below  the gap that ends where the band begins
    /// @param upper  where the band ends, in band units
    bool certain_in_band(std::uint32_t cell, const Gap& below, std::int32_t upper) const;

  private:
    struct Edge {
        Vec3d a, b;
        double weight; ///< multiplicity times length over 4 pi
    };
    /// Edges that are near each other.
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

    /// @param crossings  the signed crossings with faces beyond the place
    std::optional<double> winding_at(const LatticePoint& place, int crossings) const;
    /// @param gap  the gap in which the region's place must lie
    std::int16_t winding_in(const Region& region, const Gap& gap) const;
    void append_halves(std::uint32_t cell, const Gap& gap, int depth, std::vector<GapPiece>& pieces) const;
    /// The most by which the winding number can change within `reach` of a place; infinite if the border is
    /// near.
    double largest_change(const Vec3d& place, double reach) const;

    ExactMapView surface_;
    OctahedralCells cells_;
    std::vector<Edge> edges_;
    std::vector<Group> groups_;
    int max_depth_; ///< how often a gap may be halved; negative if not even a first evaluation is affordable
};

} // namespace echinus
