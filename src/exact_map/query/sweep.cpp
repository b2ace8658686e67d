// Finds where a particle's path first crosses the surface: visits the face tree's boxes along the path,
// nearest first, and tests each face exactly.

#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "exact_map/query/ray_crossing.hpp"
#include "exact_map/query/winding.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

/// One step beyond the lattice, so that an endpoint cut off there is outside, and points that contains()
/// takes to be on the lattice are not cut off.
constexpr std::int64_t kLatticeLimit = kLatticeExtent + 1;
constexpr auto kLimit = static_cast<double>(kLatticeLimit);

using Axis = double Vec3d::*;

Axis longest_axis(const Vec3d& v) {
    const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    if (x >= y && x >= z) return &Vec3d::x;
    return y >= z ? &Vec3d::y : &Vec3d::z;
}

/// The point at which the line through two points has this coordinate along an axis; in lattice steps.
///
/// Relative to the centre C, all points p of the line have the same moment p x way = (a - C) x (b - C), which
/// equals a x b - C x way. Products of floats are exact in double, so the moment is off by no more than a few
/// roundings of itself and of |C| |way|, however far away a and b are. With the axis e, e x (p x way) is p
/// (e.way) - way (e.p).
/// @param axis  the axis along which the line advances most, so that the division does not amplify errors
Vec3d place_on_line(const LatticeFrame& frame, const Vec3d& a, const Vec3d& b, Axis axis, double coordinate) {
    const Vec3d way = b - a;
    const Vec3d moment = (cross(a, b) - cross(frame.centre, way)) * frame.inverse_step;
    Vec3d unit;
    unit.*axis = 1;
    return (way * coordinate + cross(unit, moment)) * (1 / way.*axis);
}

/// Moves one endpoint of a segment towards the other, to the limit of the lattice: there is no surface
/// beyond. The cut is measured from the other endpoint, so that it is exact if that one lies on the lattice.
/// @return false if the whole segment lies beyond the lattice
bool cut_to_lattice(Vec3d& end, const Vec3d& other) {
    double share = 1;
    for (Axis c : {&Vec3d::x, &Vec3d::y, &Vec3d::z}) {
        if (std::fabs(end.*c) <= kLimit) continue;
        const double limit = end.*c > 0 ? kLimit : -kLimit;
        if (end.*c > 0 ? other.*c > limit : other.*c < limit) return false;
        share = std::min(share, (limit - other.*c) / (end.*c - other.*c));
    }
    if (share < 1) end = other + (end - other) * share;
    return true;
}

/// Is a place close enough for cuts from here to be off by much less than a lattice step?
bool is_near(const Vec3d& place) {
    constexpr double kNear = 0x1p24;
    return (std::fabs(place.x) <= kNear) & (std::fabs(place.y) <= kNear) & (std::fabs(place.z) <= kNear);
}

/// Cuts a segment at the limits of the axis along which it advances most. Afterwards, endpoints are near
/// unless the segment lies beyond one side of the lattice.
/// @return false if the whole segment lies beyond the lattice
bool cut_far_segment(const LatticeFrame& frame, const Vec3f& from_local, const Vec3f& to_local, Vec3d& start,
                     Vec3d& end) {
    const Axis axis = longest_axis(end - start);
    const double from = start.*axis, to = end.*axis;
    if (std::min(from, to) > kLimit || std::max(from, to) < -kLimit) return false;
    const auto cut = [&](Vec3d& place) {
        if (std::fabs(place.*axis) <= kLimit) return;
        const double limit = std::copysign(kLimit, place.*axis);
        place = place_on_line(frame, Vec3d(from_local), Vec3d(to_local), axis, limit);
    };
    cut(start);
    cut(end);
    return true;
}

LatticePoint clamped(const LatticePoint& p) {
    const auto clamp = [](std::int64_t c) { return std::clamp(c, -kLatticeLimit, kLatticeLimit); };
    return {clamp(p.x), clamp(p.y), clamp(p.z)};
}

/// Lower bounds of the parameters at which a segment enters the boxes of a node's children; more than 1 for
/// boxes that it misses. Boxes are enlarged by one step, far more than the errors of single precision.
class BoxEntries {
  public:
    BoxEntries(const LatticePoint& from, const LatticePoint& to) : from_(from), way_(to - from) {}

    ChildDistances operator()(const TreeNode& node) const {
        ChildDistances result;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            float enter = 0, leave = 1;
            clip(node.low[0][k], node.high[0][k], from_.x, way_.x, enter, leave);
            clip(node.low[1][k], node.high[1][k], from_.y, way_.y, enter, leave);
            clip(node.low[2][k], node.high[2][k], from_.z, way_.z, enter, leave);
            result[k] = enter <= leave ? enter : kMissed;
        }
        return result;
    }

  private:
    static constexpr float kMissed = 2;
    static constexpr float kUnit = ExactMapView::kBoxUnit;
    static constexpr float kSlack = 1;
    /// The slack of parameters: a division and a multiplication are off by 2^-23.
    static constexpr float kParameterSlack = 1e-6F;

    static void clip(std::int16_t low, std::int16_t high, float from, float way, float& enter, float& leave) {
        const float to_low = low * kUnit - kSlack - from;
        const float to_high = high * kUnit + kSlack - from;
        if (way == 0) {
            if (to_low > 0 || to_high < 0) leave = -1;
            return;
        }
        const float near = (way > 0 ? to_low : to_high) / way - kParameterSlack;
        const float far = (way > 0 ? to_high : to_low) / way + kParameterSlack;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }

    Vec3f from_, way_;
};

struct FaceCrossing {
    SegmentCrossing crossing;
    std::uint32_t face;
};

/// Not inlined, since otherwise the code before it would cost the search registers.
[[gnu::noinline]] std::optional<FaceCrossing>
first_crossing(const ExactMapView& map, const LatticePoint& from, const LatticePoint& to) {
    std::optional<FaceCrossing> first;
    float bound = 1;
    walk_near_leaves(map, bound, BoxEntries(from, to), [&](const LeafFaces& faces) {
        for (std::uint32_t face = faces.first; face < faces.last; ++face) {
            const auto crossing = crossing_with_face(face_corners(map, face), from, to);
            if (!crossing || (first && !crossing->before(first->crossing))) continue;
            first = FaceCrossing{*crossing, face};
            bound = static_cast<float>(crossing->fraction()) + 1e-6F;
        }
    });
    return first;
}

/// Do both endpoints lie in the same gap of one cell? The region between planes through the centre and two
/// parallel planes across them is convex, so it contains the whole path, and no surface. Most paths of a
/// cloth's particles end here.
bool stays_in_gap(const ExactMapView& map, const LatticePoint& from, const LatticePoint& to) {
    const OctahedralCells cells(map.divisions);
    const std::uint32_t cell = cells.locate(from).cell;
    if (cell != cells.locate(to).cell) return false;
    const BandRange bands = bands_of_cell(map, cell);
    const std::int64_t t_from = band_unit_of(l1_norm(from));
    const std::int64_t t_to = band_unit_of(l1_norm(to));
    for (std::uint32_t band = bands.first; band < bands.last; ++band) {
        if (t_from >= map.bands[band].upper && t_to >= map.bands[band].upper) continue;
        return t_from < map.bands[band].lower && t_to < map.bands[band].lower;
    }
    return true;
}

} // namespace

SweepHit sweep(const ExactMapView& map, Vec3f from_local, Vec3f to_local) noexcept {
    SweepHit hit;
    hit.point = to_local;
    if (!is_finite(from_local) || !is_finite(to_local)) return hit;
    const LatticeFrame frame = frame_of(map);
    const Vec3d from_place = frame.to_lattice(from_local), to_place = frame.to_lattice(to_local);
    Vec3d start = from_place, end = to_place;
    if (!(is_near(start) && is_near(end)) && !cut_far_segment(frame, from_local, to_local, start, end))
        return hit;
    if (!cut_to_lattice(start, end) || !cut_to_lattice(end, start)) return hit;
    const LatticePoint from = clamped(rounded(start));
    const LatticePoint to = clamped(rounded(end));
    if (from == to || stays_in_gap(map, from, to)) return hit;
    const std::optional<FaceCrossing> first = first_crossing(map, from, to);
    if (!first) return hit;
    const double share = std::clamp(first->crossing.fraction(), 0.0, 1.0);
    const Vec3d place = start + (end - start) * share;
    const double fraction = std::min(1.0, length(place - from_place) / length(to_place - from_place));
    // Faces may have the opposite orientation; only the side of this face that is solid matters.
    const std::int64_t before = winding_at(map, from, WindingGoal::Turn::AtEveryHalf).number;
    const std::int64_t after = before + (first->crossing.entering() ? 1 : -1);
    const bool inside_before = is_inside(map.rule, before), inside_after = is_inside(map.rule, after);
    const bool turned =
        first->crossing.entering() ? inside_before && !inside_after : inside_after && !inside_before;
    const Vec3d normal = Vec3d(first->crossing.normal) * (turned ? -1.0 : 1.0);
    hit.fraction = static_cast<float>(fraction);
    hit.point = Vec3f(frame.to_local(place));
    hit.normal = Vec3f(normal * (1 / length(normal)));
    hit.face = map.face_numbers[first->face];
    hit.entering = inside_after && !inside_before;
    return hit;
}

void sweep_batch(const ExactMapView& map, StridedSpan<const Vec3f> from_local,
                 StridedSpan<const Vec3f> to_local, std::span<SweepHit> hits,
                 unsigned thread_count) noexcept {
    if (!is_met(from_local.size() == hits.size() && to_local.size() == hits.size(),
                "sweep_batch: starts, ends and hits differ in number"))
        return;
    answer_each(hits, thread_count, [&](std::size_t i) { return sweep(map, from_local[i], to_local[i]); });
}

} // namespace echinus
