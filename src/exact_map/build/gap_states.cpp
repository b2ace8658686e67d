#include "exact_map/build/gap_states.hpp"

#include "exact_map/layout.hpp"
#include "exact_map/query/winding.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace echinus {

namespace {

constexpr int kUnit = ExactMapView::kBandUnit;
constexpr double kTolerance = 1e-3;                               ///< error of winding numbers
constexpr double kMostChange = 0.5 - kCertainMargin - kTolerance; ///< within a region that is certain

double distance_to_segment(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double share = std::clamp(dot(place - a, ab) / dot(ab, ab), 0.0, 1.0);
    return length(place - a - ab * share);
}

/// How often gaps may be halved so that fewer than 10^8 distances would be computed if groups did not save
/// most of them: about a tenth of a second on one core.
int affordable_halvings(std::size_t edge_count, std::size_t cell_count, int most) {
    constexpr std::size_t kManyEdges = 200; // with more border edges, few gaps are certain
    if (edge_count > kManyEdges) return GapStates::kNone;
    constexpr double kMostDistances = 1e8;
    constexpr double kGapsPerCell = 3;
    const double distances_per_piece =
        kGapsPerCell * static_cast<double>(edge_count) * static_cast<double>(cell_count);
    int halvings = GapStates::kNone;
    for (double pieces = 1; halvings < most && pieces * distances_per_piece <= kMostDistances;
         pieces = 2 * pieces + 1)
        ++halvings;
    return halvings;
}

} // namespace

/// A cell between two limits in band units, and the lattice point on the ray through the cell's middle, next
/// to a given L1 norm, at which the winding number is computed.
struct GapStates::Region {
    LatticePoint place;
    double reach; ///< no point of the region is farther from `place`

    Region(const OctahedralCells& cells, std::uint32_t cell, std::int32_t lower, std::int32_t upper,
           double norm)
        : place(place_on_middle(cells, cell, norm)), reach(0) {
        for (const Vec3d& corner : cells.corners(cell))
            for (std::int32_t limit : {lower, upper})
                reach = std::max(reach, length(corner * (limit * kUnit) - Vec3d(place)));
    }

  private:
    /// A multiple of the first lattice point on the middle ray. Never the origin, from which rays run in
    /// other directions.
    static LatticePoint place_on_middle(const OctahedralCells& cells, std::uint32_t cell, double norm) {
        const LatticePoint middle = cells.middle(cell);
        const std::int64_t first_norm = 3 * cells.divisions();
        const std::int64_t multiple = kLatticeExtent / first_norm;
        const LatticePoint first{middle.x / multiple, middle.y / multiple, middle.z / multiple};
        const double multiples = std::round(norm / static_cast<double>(first_norm));
        return first * std::max(truncated_to<std::int64_t>(multiples), std::int64_t{1});
    }
};

GapStates::GapStates(const ExactMapView& surface, const OctahedralCells& cells, int most_halvings)
    : surface_(surface), cells_(cells),
      max_depth_(surface.winding_tree->neighbours_disagree
                     ? kNone // certainty depends on more than the winding number
                     : affordable_halvings(surface.border.size(), cells.count(), most_halvings)) {
    if (max_depth_ == kNone) return;
    for (const BorderEdge& edge : surface.border) {
        const Vec3d a(surface.vertices[edge.a]), b(surface.vertices[edge.b]);
        edges_.push_back({a, b, std::abs(edge.multiplicity) * length(b - a) / (4 * std::numbers::pi)});
    }
    put_neighbours_together();
    make_groups();
}

/// Sorts the edges so that each is followed by the nearest of the remaining ones.
void GapStates::put_neighbours_together() {
    for (std::size_t last = 0; last + 1 < edges_.size(); ++last) {
        const auto from_last = [end = edges_[last].b](const Edge& edge) { return length(edge.a - end); };
        const auto rest = std::span(edges_).subspan(last + 1);
        const auto nearest = std::min_element(rest.begin(), rest.end(), [&](const Edge& x, const Edge& y) {
            return from_last(x) < from_last(y);
        });
        std::swap(rest.front(), *nearest);
    }
}

void GapStates::make_groups() {
    for (std::size_t first = 0; first < edges_.size(); first += kGroupSize) {
        const std::size_t count = std::min(kGroupSize, edges_.size() - first);
        Group group{{}, 0, 0, first, count};
        for (const Edge& edge : edges_of(group))
            group.centre = group.centre + (edge.a + edge.b) * (0.5 / static_cast<double>(count));
        for (const Edge& edge : edges_of(group)) {
            group.weight += edge.weight;
            group.radius =
                std::max({group.radius, length(edge.a - group.centre), length(edge.b - group.centre)});
        }
        groups_.push_back(group);
    }
}

std::span<const GapStates::Edge> GapStates::edges_of(const Group& group) const {
    return std::span(edges_).subspan(group.first, group.count);
}

double GapStates::largest_change(const Vec3d& place, double reach) const {
    constexpr double kFar = 8; // in radii; at this distance a group is hardly nearer than its edges
    const auto slope = [](double weight, double clearance) {
        return clearance > 0 ? weight / (clearance * clearance) : std::numeric_limits<double>::infinity();
    };
    double sum = 0;
    for (const Group& group : groups_) {
        const double distance = length(place - group.centre) - reach;
        if (distance > kFar * group.radius)
            sum += slope(group.weight, distance - group.radius);
        else
            for (const Edge& edge : edges_of(group))
                sum += slope(edge.weight, distance_to_segment(place, edge.a, edge.b) - reach);
        if (sum * reach > kMostChange) break; // the result is known to be too large
    }
    return sum * reach;
}

/// Beyond the lattice there are neither faces nor caps.
std::optional<double> GapStates::winding_at(const LatticePoint& place, int crossings) const {
    const bool on_lattice = is_on_lattice(Vec3d(place));
    if (surface_.winding_tree->has_caps && on_lattice) crossings += cap_crossings(surface_, place);
    return decided_winding_by_tree(surface_, Vec3d(place), on_lattice ? &place : nullptr,
                                   surface_.winding_tree->has_caps ? crossings : 0,
                                   {WindingGoal::Turn::AtEveryHalf, kTolerance});
}

std::int16_t GapStates::winding_in(const Region& region, const Gap& gap) const {
    const std::int64_t norm = l1_norm(region.place);
    if (norm < gap.lower * kUnit || norm >= gap.upper * kUnit) return ExactMapView::kUncertain;
    const double change = largest_change(Vec3d(region.place), region.reach);
    if (!(change < kMostChange)) return ExactMapView::kUncertain;
    const std::optional<double> winding = winding_at(region.place, gap.crossings);
    if (!winding) return ExactMapView::kUncertain;
    const double whole = std::round(*winding);
    constexpr double kMostStored = 32'000;
    const bool certain = std::fabs(*winding - whole) + change < kMostChange && std::fabs(whole) < kMostStored;
    return certain ? truncated_to<std::int16_t>(whole) : ExactMapView::kUncertain;
}

void GapStates::append_pieces(std::uint32_t cell, const Gap& gap, std::vector<GapPiece>& pieces) const {
    if (gap.lower >= gap.upper) return;
    if (max_depth_ == kNone)
        pieces.push_back({kept_as<std::uint16_t>(gap.upper), ExactMapView::kUncertain});
    else
        append_halves(cell, gap, 0, pieces);
}

void GapStates::append_halves(std::uint32_t cell, const Gap& gap, int depth,
                              std::vector<GapPiece>& pieces) const {
    const std::int32_t sum = gap.lower + gap.upper;
    const Region region(cells_, cell, gap.lower, gap.upper, 0.5 * kUnit * sum);
    const std::int16_t winding = winding_in(region, gap);
    if (winding == ExactMapView::kUncertain && depth < max_depth_ && gap.upper - gap.lower > 1) {
        append_halves(cell, {gap.lower, sum / 2, gap.crossings}, depth + 1, pieces);
        append_halves(cell, {sum / 2, gap.upper, gap.crossings}, depth + 1, pieces);
        return;
    }
    if (!pieces.empty() && pieces.back().winding == winding)
        pieces.back().upper = kept_as<std::uint16_t>(gap.upper);
    else
        pieces.push_back({kept_as<std::uint16_t>(gap.upper), winding});
}

bool GapStates::certain_in_band(std::uint32_t cell, const Gap& below, std::int32_t upper) const {
    if (max_depth_ == kNone) return false;
    const double norm =
        kUnit * below.upper - 0.5 - 1.5 * cells_.divisions(); // rounds to the last point before the band
    const Region region(cells_, cell, below.upper, upper, norm);
    return winding_in(region, below) != ExactMapView::kUncertain;
}

} // namespace echinus
