#include "exact_map/query/winding.hpp"

#include "directions/face_cone.hpp"
#include "directions/lattice.hpp"
#include "exact_map/layout.hpp"
#include "exact_map/query/place_in_bands.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "geometry/elementary.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/exact_map_view.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace echinus {

// The effect of the border of an open surface on winding numbers.
//
// Close the surface with a cone: a triangle from each border edge to the origin of the lattice. The rays from
// the origin see that cone edge-on and never cross it, so the signed crossings of a particle's ray beyond the
// particle are the winding number of the closed surface, an integer. The generalised winding number of the
// open surface (Jacobson et al. 2013) is that integer minus the contribution of the cone:
//
//     w(p) = crossings_beyond(p) + border_part(p),  border_part = - sum of solid angles of the cone / 4 pi.
//
// Builds compute this sum, and so do queries whose answer rounding would leave open; other queries sum caps
// of the border (build/open_surface.hpp), most of which are far away from most points.

namespace {

/// A tiny step in the direction in which the perturbation (e, e^2, e^3) first leads away from a ray.
Vec3d nudge_from_ray(const LatticePoint& d) {
    constexpr double kHair =
        0x1p-22; // lattice steps: less than the distances between lattice points and rays, more than rounding
    // At the origin, the tip of all cone triangles, only the direction matters: it must avoid their sides.
    if (d == LatticePoint{}) return {0x1p-10, 0x1p-31, 0x1p-52};
    const bool along_x = d.y == 0 && d.z == 0;
    return along_x ? Vec3d{0, kHair, 0} : Vec3d{kHair, 0, 0};
}

/// Solid angle of the cone triangle (origin, a, b) seen from share * d. The side of the triangle on which
/// that point lies, where the angle jumps by 4 pi, is decided exactly, and so is whether it lies in the
/// triangle's plane. In that plane, above all on the sides through the origin, along which rays run through
/// border vertices, the point is nudged, so that the two triangles on both sides of such a ray add up. Van
/// Oosterom and Strackee 1983, as in mesh/judges.cpp.
double cone_solid_angle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& d, double share) {
    const LatticePoint normal = cross(a, b);
    const std::int64_t volume = -dot(d, normal);
    const Vec3d nudge = volume == 0 ? nudge_from_ray(d) : Vec3d{};
    const Vec3d p = Vec3d(d) * share + nudge;
    const Vec3d pa = Vec3d(a) - p, pb = Vec3d(b) - p, po = p * -1.0;
    const double la = length(pa), lb = length(pb), lo = length(po);
    const double numerator =
        volume == 0 ? std::fabs(dot(nudge, Vec3d(normal))) : share * std::fabs(static_cast<double>(volume));
    const double denominator = la * lb * lo + dot(pa, pb) * lo + dot(pb, po) * la + dot(po, pa) * lb;
    const double angle = 2 * portable_atan2(numerator, denominator);
    const bool positive = volume != 0 ? volume > 0 : sign_of_perturbation(normal) < 0;
    return positive ? angle : -angle;
}

/// The contribution of the border to the generalised winding number, in addition to the signed crossings
/// beyond share * d. A point on the cone counts as displaced by (e, e^2, e^3), as everywhere.
double border_part(std::span<const BorderEdge> border, std::span<const Vec3<std::int32_t>> vertices,
                   const LatticePoint& d, double share = 1) {
    double sum = 0;
    for (const BorderEdge& edge : border)
        sum += edge.multiplicity *
               cone_solid_angle(LatticePoint(vertices[edge.a]), LatticePoint(vertices[edge.b]), d, share);
    return sum / (4 * std::numbers::pi);
}

constexpr std::size_t kWidth = TreeNode::kWidth;

/// The ray from a particle away from the origin.
class OutwardRay {
  public:
    explicit OutwardRay(const LatticePoint& p)
        : from_{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)} {
        // At the origin the ray runs in the direction of the perturbation: first along x.
        const std::array<double, 3> along{p == LatticePoint{} ? 1 : from_[0], from_[1], from_[2]};
        constexpr double kAcross = 1e30; // the inverse of a zero displacement along an axis
        for (std::size_t i = 0; i < 3; ++i) inverse_[i] = along[i] == 0 ? kAcross : 1 / along[i];
    }

    /// The boxes of a node that the ray meets, enlarged by one lattice step, which exceeds the rounding
    /// errors and the perturbation of the ray.
    std::array<bool, kWidth> meets(const TreeNode& node) const {
        std::array<double, kWidth> begin{}, end;
        end.fill(1e30);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < kWidth; ++k) {
                const double low = node.low[i][k] * ExactMapView::kBoxUnit - 1;
                const double high = node.high[i][k] * ExactMapView::kBoxUnit + 1;
                const double s = (low - from_[i]) * inverse_[i], t = (high - from_[i]) * inverse_[i];
                begin[k] = std::max(begin[k], std::min(s, t));
                end[k] = std::min(end[k], std::max(s, t));
            }
        }
        std::array<bool, kWidth> result;
        for (std::size_t k = 0; k < kWidth; ++k)
            result[k] = (begin[k] <= end[k]) & (node.low[0][k] <= node.high[0][k]); // is there such a child?
        return result;
    }

  private:
    std::array<double, 3> from_, inverse_{};
};

int crossings_of_leaf(const ExactMapView& map, std::uint32_t leaf, const LatticePoint& p) {
    const CrossingFilter filter(p);
    const IndexArray& corners = map.winding_tree->corners;
    const std::size_t first = leaf * kWidth, last = std::min(first + kWidth, corners.size() / 3);
    int sum = 0;
    for (std::size_t cap = first; cap < last; ++cap) {
        const auto vertex = [&](std::size_t k) { return map.vertices[corners[3 * cap + k]]; };
        const auto a = vertex(0), b = vertex(1), c = vertex(2);
        const auto [crossing, sure] = filter(RaySide::Beyond, &a.x, &b.x, &c.x);
        sum += sure ? crossing
                    : crossing_on(RaySide::Beyond, {LatticePoint(a), LatticePoint(b), LatticePoint(c)}, p);
    }
    return sum;
}

} // namespace

int cap_crossings(const ExactMapView& map, const LatticePoint& p) noexcept {
    const OutwardRay ray(p);
    constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
    std::array<std::uint32_t, kMaxDepth * kWidth> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    int sum = 0;
    while (count > 0) {
        const std::uint32_t child = waiting[--count];
        if ((child & TreeNode::kLeaf) != 0) {
            sum += crossings_of_leaf(map, child - TreeNode::kLeaf, p);
            continue;
        }
        const TreeNode& node = map.winding_tree->nodes[child];
        const std::array<bool, kWidth> met = ray.meets(node);
        for (std::size_t k = 0; k < kWidth; ++k)
            if (met[k]) waiting[count++] = node.children[k];
    }
    return sum;
}

namespace {

/// The lists of a map, with the types that they are stored in.
template <typename Face, typename Vertex>
struct Lists {
    const ExactMapView& map;
    const Face* references;
    const Vertex* corners;

    const std::int32_t* corner(std::uint32_t face, std::size_t k) const {
        return &map.vertices[corners[3 * std::size_t{face} + k]].x;
    }

    /// Signed crossings of a particle's ray with references [first, last), on one side of the particle.
    /// @param part  the part of the cell in which the particle lies
    int crossings(RaySide side, std::uint32_t first, std::uint32_t last, std::uint32_t part,
                  const LatticePoint& p) const {
        const CrossingFilter filter(p);
        constexpr std::uint32_t kPieceSize = 64;
        std::array<Face, kPieceSize> faces;
        int sum = 0;
        for (std::uint32_t begin = first; begin < last; begin += kPieceSize) {
            const std::uint32_t end = std::min(begin + kPieceSize, last);
            std::uint32_t count = 0; // number of faces that touch the part; they are listed without a branch
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

/// Clang requires a deduction guide for an aggregate.
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
    const int crossings = map.winding_tree->has_caps ? crossings_beyond(map, p) + cap_crossings(map, p) : 0;
    if (const auto winding = decided_winding_by_tree(map, Vec3d(p), &p, crossings, goal)) return *winding;
    return crossings_beyond(map, p) + border_part(map.border, map.vertices, p);
}

/// The generalised winding number of a finite place beyond the lattice; it decreases with the distance.
double winding_beyond_lattice(const ExactMapView& map, const Vec3d& place, const WindingGoal& goal) {
    if (const auto winding = decided_winding_by_tree(map, place, nullptr, 0, goal)) return *winding;
    const double largest = std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
    const double shrink = static_cast<double>(kLatticeExtent) / largest;
    return border_part(map.border, map.vertices, rounded(place * shrink), 1 / shrink);
}

Winding winding_of(double generalised, WindingGoal::Turn turn) {
    return {nearest_whole(generalised), distance_from_turn(generalised, turn) >= kCertainMargin, true};
}

/// If neighbours disagree about the outside, the winding number is that of an unintended surface. But rays
/// leave a solid as often as they enter it, whatever the orientation of its faces: an answer is certain only
/// if the parity of the crossings agrees with it.
Winding computed_winding_at(const ExactMapView& map, const LatticePoint& p, WindingGoal::Turn turn) {
    Winding winding = winding_of(generalised_winding(map, p, {turn}), turn);
    if (map.winding_tree->neighbours_disagree && winding.certain)
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
