#include "exact_map/build/gap_states.hpp"

#include "exact_map/border_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace echinus {

namespace {

constexpr double kUnit = ExactMapView::kBandUnit;

double distance_to_segment(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double share = std::clamp(dot(place - a, ab) / dot(ab, ab), 0.0, 1.0);
    return length(place - a - ab * share);
}

/// How often gaps may be halved so that the distances looked at stay below 10^8, a tenth of a second on one
/// core.
int affordable_halvings(std::size_t edge_count, std::size_t cell_count, int most) {
    constexpr std::size_t kManyEdges = 200; // beside so many, little is found
    if (edge_count > kManyEdges) return -1;
    constexpr double kMostDistances = 1e8;
    constexpr double kGapsPerCell = 3;
    const double distances_per_piece =
        kGapsPerCell * static_cast<double>(edge_count) * static_cast<double>(cell_count);
    int halvings = -1;
    for (double pieces = 1; halvings < most && pieces * distances_per_piece <= kMostDistances;
         pieces = 2 * pieces + 1)
        ++halvings;
    return halvings;
}

} // namespace

/// A cell between two L1 norms, and a place in it on the ray through the cell's middle.
struct GapStates::Region {
    LatticePoint direction;
    double share; ///< the place is share * direction
    double reach; ///< no point of the region is farther from it

    Region(const OctahedralCells& cells, std::uint32_t cell, double lower, double upper, double at)
        : direction(cells.middle(cell)),
          share(at / static_cast<double>(std::max<std::int64_t>(l1_norm(direction), 1))), reach(0) {
        for (const Vec3d& corner : cells.corners(cell))
            for (double t : {lower, upper}) reach = std::max(reach, length(corner * t - place()));
    }

    Vec3d place() const { return Vec3d(direction) * share; }
};

GapStates::GapStates(const LatticeMesh& lattice, std::span<const BorderEdge> border,
                     const OctahedralCells& cells, int most_halvings)
    : border_(border), cells_(cells), vertices_(lattice.vertices.begin(), lattice.vertices.end()),
      max_depth_(affordable_halvings(border.size(), cells.count(), most_halvings)) {
    for (const BorderEdge& edge : border) {
        const Vec3d a(lattice.vertices[edge.a]), b(lattice.vertices[edge.b]);
        edges_.push_back({a, b, std::abs(edge.multiplicity) * length(b - a) / (4 * std::numbers::pi)});
    }
}

double GapStates::largest_change(const Vec3d& place, double reach) const {
    double slope = 0;
    for (const Edge& edge : edges_) {
        const double clearance = distance_to_segment(place, edge.a, edge.b) - reach;
        if (!(clearance > 0)) return std::numeric_limits<double>::infinity();
        slope += edge.weight / (clearance * clearance);
        if (slope * reach > 1) return slope * reach; // enough to know
    }
    return slope * reach;
}

std::int16_t GapStates::winding_in(const Region& region, int crossings) const {
    constexpr double kAllowed = 0.5 - kCertainMargin;
    const double change = largest_change(region.place(), region.reach);
    if (change >= kAllowed) return ExactMapView::kUncertain;
    const double winding = crossings + border_part(border_, vertices_, region.direction, region.share);
    const double whole = std::round(winding);
    constexpr double kRounding = 1e-6;
    constexpr double kMostStored = 32'000;
    const bool certain =
        std::fabs(winding - whole) + change < kAllowed - kRounding && std::fabs(whole) < kMostStored;
    return certain ? static_cast<std::int16_t>(whole) : ExactMapView::kUncertain;
}

void GapStates::append_pieces(std::uint32_t cell, std::int32_t lower, std::int32_t upper, int crossings,
                              std::vector<GapPiece>& pieces) const {
    if (lower >= upper) return;
    if (max_depth_ < 0)
        pieces.push_back({static_cast<std::uint16_t>(upper), ExactMapView::kUncertain});
    else
        append_halves(cell, lower, upper, crossings, 0, pieces);
}

void GapStates::append_halves(std::uint32_t cell, std::int32_t lower, std::int32_t upper, int crossings,
                              int depth, std::vector<GapPiece>& pieces) const {
    const double middle = 0.5 * (lower + upper);
    const Region region(cells_, cell, lower * kUnit, upper * kUnit, middle * kUnit);
    const std::int16_t winding = winding_in(region, crossings);
    if (winding == ExactMapView::kUncertain && depth < max_depth_ && upper - lower > 1) {
        const std::int32_t half = (lower + upper) / 2;
        append_halves(cell, lower, half, crossings, depth + 1, pieces);
        append_halves(cell, half, upper, crossings, depth + 1, pieces);
        return;
    }
    if (!pieces.empty() && pieces.back().winding == winding)
        pieces.back().upper = static_cast<std::uint16_t>(upper);
    else
        pieces.push_back({static_cast<std::uint16_t>(upper), winding});
}

bool GapStates::certain_in_band(std::uint32_t cell, std::int32_t lower, std::int32_t upper,
                                int crossings) const {
    if (max_depth_ < 0) return false;
    const Region region(cells_, cell, lower * kUnit, upper * kUnit, upper * kUnit);
    return winding_in(region, crossings) != ExactMapView::kUncertain;
}

} // namespace echinus
