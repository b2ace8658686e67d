#pragma once

#include "geometry/orientation.hpp"

#include <array>
#include <optional>

namespace echinus {

/// A closed point, segment or triangle. Its corners may coincide or be collinear.
struct Simplex {
    std::array<Vec3f, 3> corners; ///< only the first `count` are used
    int count = 0;                ///< 1 to 3

    void push_back(const Vec3f& corner) { corners[count++] = corner; }
    /// Edge i, below edge_count(), runs from corner i to the next. A point has one edge of length 0.
    int edge_count() const { return count == 3 ? 3 : 1; }
    const Vec3f& next(int i) const { return corners[i + 1 < count ? i + 1 : 0]; }
};

/// Do they have a point in common? Decided exactly. @pre finite
bool simplices_meet(const Simplex& a, const Simplex& b) noexcept;

/// Projects a point along an axis, by dropping one of its coordinates; orientation is preserved.
inline Point2 seen_along(int axis, const Vec3f& p) {
    if (axis == 0) return {p.y, p.z};
    if (axis == 1) return {p.z, p.x};
    return {p.x, p.y};
}

/// An axis along which three points are not seen as collinear; none if they are collinear.
std::optional<int> axis_that_shows(const Vec3f& a, const Vec3f& b, const Vec3f& c) noexcept;

} // namespace echinus
