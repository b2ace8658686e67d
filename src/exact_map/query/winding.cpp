#include "exact_map/query/winding.hpp"

#include "exact_map/border_part.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/query/cap_crossings.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus {

namespace {

/// The lists of a map with the width of their numbers known.
template <typename Face, typename Vertex>
struct Lists {
    const ExactMapView& map;
    const Face* references;
    const Vertex* corners;

    const std::int32_t* corner(std::uint32_t face, std::size_t k) const {
        return &map.vertices[corners[3 * std::size_t{face} + k]].x;
    }

    /// Signed crossings of a particle's ray with references [first, last), on one side of the particle.
    /// @param part  of its cell in which the particle lies
    int crossings(RaySide side, std::uint32_t first, std::uint32_t last, std::uint32_t part,
                  const LatticePoint& p) const {
        const CrossingFilter filter(p);
        constexpr std::uint32_t kPieceSize = 64;
        std::array<Face, kPieceSize> faces;
        int sum = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPieceSize) {
            const std::uint32_t end = std::min(begin + kPieceSize, last);
            std::uint32_t count = 0; // of the faces that touch the part; listed without a branch
            for (std::uint32_t r = begin; r < end; ++r) {
                faces[count] = references[r];
                count += std::uint32_t{map.reference_parts[r]} >> part & 1U;
            }
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint32_t face = faces[i];
                const auto [crossing, sure] = filter(side, corner(face, 0), corner(face, 1), corner(face, 2));
                sum += sure ? crossing : crossing_on(side, face_corners(map, face), p);
            }
        }
        return sum;
    }
};

/// Clang needs a deduction guide for an aggregate.
template <typename Face, typename Vertex>
Lists(const ExactMapView&, const Face*, const Vertex*) -> Lists<Face, Vertex>;

int crossings_in_band(const ExactMapView& map, RaySide side, std::uint32_t band, std::uint32_t part,
                      const LatticePoint& p) {
    const auto crossings = [&](const auto& lists) {
        return lists.crossings(side, map.bands[band].first_reference, map.bands[band + 1].first_reference,
                               part, p);
    };
    const auto with_corners = [&](const auto* references) {
        return map.corners.wide.empty() ? crossings(Lists{map, references, map.corners.narrow.data()})
                                        : crossings(Lists{map, references, map.corners.wide.data()});
    };
    return map.references.wide.empty() ? with_corners(map.references.narrow.data())
                                       : with_corners(map.references.wide.data());
}

/// Signed crossings of a particle's ray with all faces beyond the particle.
int crossings_beyond(const ExactMapView& map, const LatticePoint& p) {
    const auto [cell, part] = OctahedralCells(map.divisions).locate(p);
    const std::int64_t t = band_unit_of(l1_norm(p));
    const BandRange bands = bands_of_cell(map, cell);
    int crossings = 0;
    for (std::uint32_t band = bands.first; band < bands.last; ++band)
        if (t < map.bands[band].upper) crossings += crossings_in_band(map, RaySide::Beyond, band, part, p);
    return crossings;
}

/// The generalised winding number of an open surface.
double generalised_winding(const ExactMapView& map, const LatticePoint& p, const WindingGoal& goal) {
    const int crossings = map.winding_tree_has_caps ? crossings_beyond(map, p) + cap_crossings(map, p) : 0;
    if (const auto winding = decided_winding_by_tree(map, Vec3d(p), &p, crossings, goal)) return *winding;
    return crossings_beyond(map, p) + border_part(map.border, map.vertices, p);
}

/// That of a place beyond the lattice, where it fades with the distance. @pre the place is finite
double winding_beyond_lattice(const ExactMapView& map, const Vec3d& place, const WindingGoal& goal) {
    if (const auto winding = decided_winding_by_tree(map, place, nullptr, 0, goal)) return *winding;
    const double largest = std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
    const double shrink = static_cast<double>(kLatticeExtent) / largest;
    return border_part(map.border, map.vertices, rounded(place * shrink), 1 / shrink);
}

Winding winding_of(double generalised, WindingGoal::Turn turn) {
    return {nearest_whole(generalised), distance_from_turn(generalised, turn) >= kCertainMargin, true};
}

/// Where neighbours disagree about the outside, the winding number is that of a surface which nobody meant.
/// But rays leave a solid as often as they enter it, whichever way its faces run: an answer is certain only
/// if that does not contradict it.
Winding computed_winding_at(const ExactMapView& map, const LatticePoint& p, WindingGoal::Turn turn) {
    Winding winding = winding_of(generalised_winding(map, p, {turn}), turn);
    if (map.neighbours_disagree && winding.certain)
        winding.certain = is_inside(map.rule, winding.number) == (crossings_beyond(map, p) % 2 != 0);
    return winding;
}

} // namespace

Winding winding_at(const ExactMapView& map, const LatticePoint& p, WindingGoal::Turn turn) noexcept {
    const OctahedralCells::Place place = OctahedralCells(map.divisions).locate(p);
    const std::int64_t t = band_unit_of(l1_norm(p));
    if (t >= map.outer_limits[place.cell])
        return map.border.empty() ? Winding{} : computed_winding_at(map, p, turn);
    const PlaceInBands at = place_in_bands(map, place, t);
    const int winding = winding_in_bands(map, at, [&](RaySide side, const PlaceInBands& in) {
        return crossings_in_band(map, side, in.band, in.part, p);
    });
    if (winding == ExactMapView::kUncertain) return computed_winding_at(map, p, turn);
    return {winding};
}

Winding winding_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local) noexcept {
    const Vec3d place = frame.to_lattice(point_local);
    if (is_on_lattice(place)) return winding_at(map, rounded(place));
    if (map.border.empty() || !is_finite(place)) return {};
    const WindingGoal::Turn turn = turn_of_side(map);
    return winding_of(winding_beyond_lattice(map, place, {turn}), turn);
}

double winding_number_at(const ExactMapView& map, const LatticeFrame& frame, const Vec3f& point_local,
                         double tolerance) noexcept {
    const Vec3d place = frame.to_lattice(point_local);
    if (!is_finite(place)) return 0;
    const bool on_lattice = is_on_lattice(place);
    if (map.border.empty())
        return on_lattice ? static_cast<double>(winding_at(map, rounded(place)).number) : 0;
    const WindingGoal goal{WindingGoal::Turn::AtEveryHalf, tolerance};
    return on_lattice ? generalised_winding(map, rounded(place), goal)
                      : winding_beyond_lattice(map, place, goal);
}

} // namespace echinus
