#pragma once

#include "directions/face_cone.hpp"

#include <array>
#include <cstdint>
#include <optional>

/// Where a segment of the lattice crosses a face, decided exactly. Both ends are perturbed alike: p counts as
/// p + (e, e^2, e^3), so that along a segment the signed crossings add up to the change of the winding
/// number.
namespace echinus {

/// Holds the product of two int64.
__extension__ using Int128 = __int128;

/// A crossing at distance / (distance of both ends) of the way.
struct SegmentCrossing {
    LatticePoint normal;        ///< of the face, not of unit length
    std::int64_t from_distance; ///< of `from` along the normal; below 2^63
    std::int64_t way;           ///< how far the segment goes against the normal: not 0

    bool entering() const { return way > 0; }
    double fraction() const { return static_cast<double>(from_distance) / static_cast<double>(way); }

    /// Which comes first? Where both are at one place, the perturbation decides: it moves crossing k by
    /// normal_k . (e, e^2, e^3) / way_k.
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
        const Int128 left = Int128{mine} * other.way;
        const Int128 right = Int128{theirs} * way;
        const int sign = (left > right) - (left < right);
        return (way > 0) == (other.way > 0) ? sign : -sign;
    }
};

/// @param from, to  components within kLatticeExtent + 1: then every number stays below 2^63
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
    // - from)). No edge is parallel to it, or both ends would be on one side.
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
