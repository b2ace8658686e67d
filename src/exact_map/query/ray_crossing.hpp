#pragma once

#include "directions/face_cone.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace echinus {

// How a face counts for a particle p of the lattice: +1 or -1 if the ray from the origin through p leaves or
// enters the solid there, on the given side of p, otherwise 0. Particle and ray are perturbed together: p
// counts as p + (e, e^2, e^3), as in directions/face_cone.hpp.

enum class RaySide : std::uint8_t {
    Before, ///< between the origin and p
    Beyond, ///< beyond p
};

/// The specification, in integers.
inline int crossing_on(RaySide side, const std::array<LatticePoint, 3>& face, const LatticePoint& p) {
    const auto& [a, b, c] = face;
    const FaceCone cone(a, b, c);
    if (cone.edge_on() || !cone.meets(p)) return 0;
    // The face is crossed beyond p if p and the origin lie on one side of its plane.
    const LatticePoint normal = cross(b - a, c - a);
    const std::int64_t before_plane = dot(normal, a - p);
    const bool beyond = before_plane != 0 ? (before_plane > 0) == cone.outward()
                                          : (sign_of_perturbation(normal) < 0) == cone.outward();
    if (beyond != (side == RaySide::Beyond)) return 0;
    return cone.outward() ? 1 : -1;
}

/// The same by a filter in double, which decides all but one face in a million without a branch that a
/// processor could mispredict.
///
/// Corners are sheared along p until p lies on its longest axis k: a point v becomes v - p * (v_k / p_k), and
/// the side on which the ray passes an edge is the sign of an area in the plane perpendicular to k (as in
/// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", 2013). Rounding is bounded throughout.
class CrossingFilter {
  public:
    explicit CrossingFilter(const LatticePoint& p) {
        const std::array<std::int64_t, 3> c{p.x, p.y, p.z};
        // Written without a branch on which component is the longest.
        std::uint32_t k = std::abs(c[1]) > std::abs(c[0]) ? 1 : 0;
        k = std::abs(c[2]) > std::abs(c[k]) ? 2 : k;
        k_axis_ = k;
        u_axis_ = kNext[k];
        v_axis_ = kNext[k + 1];
        pk_ = static_cast<double>(c[k_axis_]);
        u_per_k_ = static_cast<double>(c[u_axis_]) / pk_;
        v_per_k_ = static_cast<double>(c[v_axis_]) / pk_;
        length_ = std::fabs(pk_);
        sign_ = pk_ > 0 ? 1 : -1;
    }

    struct Verdict {
        int crossing; ///< the result of crossing_on(), if sure
        bool sure;
    };

    /// @param a, b, c  corners of the face, three coordinates each
    Verdict operator()(RaySide side, const std::int32_t* a, const std::int32_t* b,
                       const std::int32_t* c) const {
        const Sheared pa = shear(a), pb = shear(b), pc = shear(c);
        // Twice the areas between the ray and each edge; below 2^42.
        const double bc = pb.u * pc.v - pb.v * pc.u;
        const double ca = pc.u * pa.v - pc.v * pa.u;
        const double ab = pa.u * pb.v - pa.v * pb.u;
        const double least = std::min(std::min(bc, ca), ab);
        const double most = std::max(std::max(bc, ca), ab);
        // & and | instead of && and || evaluate every comparison, so that there is no branch to mispredict.
        const bool front = least > kAreaError;
        const bool hit = front | (most < -kAreaError);
        const bool missed = (most > kAreaError) & (least < -kAreaError);
        // The positions at which the ray meets the plane, along k and relative to p and to the origin, times
        // the sum of the areas: both have its sign if the plane is met beyond p, only the second has it if
        // the plane is met before p, and neither if it is met behind the origin.
        const double from_p = bc * pa.ahead + ca * pb.ahead + ab * pc.ahead;
        const double from_origin = from_p + (bc + ca + ab) * length_;
        const bool beyond = (from_p > 0) == front;
        const bool forward = (from_origin > 0) == front;
        const bool counts = hit & forward & (beyond == (side == RaySide::Beyond));
        const bool sure_of_side =
            (std::fabs(from_p) > kVolumeError) & (std::fabs(from_origin) > kVolumeError);
        const int sign = front ? sign_ : -sign_;
        const bool sure = missed | (hit & sure_of_side);
        return {sign * int{counts}, sure};
    }

  private:
    struct Sheared {
        double u, v, ahead; ///< ahead: how much farther than p a point is along axis k, in the direction of p
    };

    Sheared shear(const std::int32_t* corner) const {
        const double u = corner[u_axis_], v = corner[v_axis_], k = corner[k_axis_];
        return {u - u_per_k_ * k, v - v_per_k_ * k, (k - pk_) * sign_};
    }

    // Sheared coordinates, below 2^20, are off by less than 2^-31, so products and areas are off by less than
    // 2^-9. from_p adds three products of an area and a difference below 2^20.1, so its error is less than
    // 2^13; that of from_origin is less than twice as large.
    static constexpr double kAreaError = 0x1p-9;
    static constexpr double kVolumeError = 0x1p14;

    static constexpr std::array<std::uint32_t, 4> kNext{1, 2, 0, 1}; ///< axis k is followed by these two

    std::uint32_t u_axis_, v_axis_, k_axis_;
    double u_per_k_, v_per_k_, pk_, length_;
    int sign_;
};

// Where a segment of the lattice crosses a face, decided exactly. Both endpoints are perturbed alike: p
// counts as p + (e, e^2, e^3), so that the signed crossings along a segment add up to the change of the
// winding number.

/// A crossing, at the fraction from_distance / way of the segment.
struct SegmentCrossing {
    LatticePoint normal;        ///< normal of the face, not of unit length
    std::int64_t from_distance; ///< how far `from` lies in front of the plane, along the normal; below 2^63
    std::int64_t way;           ///< how far the segment runs against the normal; not 0

    bool entering() const { return way > 0; }
    double fraction() const { return static_cast<double>(from_distance) / static_cast<double>(way); }

    /// Does this crossing come first? If both are at the same place, the perturbation decides: it moves
    /// crossing k by normal_k . (e, e^2, e^3) / way_k.
    bool before(const SegmentCrossing& other) const {
        const int by_place = compare(from_distance, other.from_distance, other);
        if (by_place != 0) return by_place < 0;
        for (std::int64_t LatticePoint::*c : {&LatticePoint::x, &LatticePoint::y, &LatticePoint::z})
            if (const int by_shift = compare(normal.*c, other.normal.*c, other)) return by_shift < 0;
        return false;
    }

  private:
    /// Sign of mine / way - theirs / other.way.
    int compare(std::int64_t mine, std::int64_t theirs, const SegmentCrossing& other) const {
        const Int128 left = wide_product(mine, other.way);
        const Int128 right = wide_product(theirs, way);
        const int sign = (left > right) - (left < right);
        return (way > 0) == (other.way > 0) ? sign : -sign;
    }
};

/// @param from, to  components within kLatticeExtent + 1, so that every number stays below 2^63
inline std::optional<SegmentCrossing> crossing_with_face(const std::array<LatticePoint, 3>& face,
                                                         const LatticePoint& from, const LatticePoint& to) {
    const auto& [a, b, c] = face;
    const LatticePoint normal = cross(b - a, c - a);
    const std::int64_t from_distance = dot(normal, from - a);
    const std::int64_t to_distance = dot(normal, to - a);
    const int at_zero = sign_of_perturbation(normal);
    const bool from_front = from_distance != 0 ? from_distance > 0 : at_zero > 0;
    const bool to_front = to_distance != 0 ? to_distance > 0 : at_zero > 0;
    if (from_front == to_front) return std::nullopt;
    // The segment's line passes the edge from v to w on the side given by the sign of way . ((v - from) x (w
    // - from)). No edge is parallel to the line, or both endpoints would be on the same side of the plane.
    const LatticePoint way = to - from;
    const auto passes_inside = [&](const LatticePoint& v, const LatticePoint& w) {
        const std::int64_t volume = dot(way, cross(v - from, w - from));
        const bool positive = volume != 0 ? volume > 0 : sign_of_perturbation(cross(way, w - v)) > 0;
        return positive != from_front;
    };
    if (!passes_inside(a, b) || !passes_inside(b, c) || !passes_inside(c, a)) return std::nullopt;
    return SegmentCrossing{normal, from_distance, from_distance - to_distance};
}

} // namespace echinus
