#include "mesh/simplices_meet.hpp"

#include <algorithm>

// Two simplices meet if an edge of one meets the other. If each lies in the other's plane, the test is done
// in that plane, projected along an axis along which the simplices keep an area.

namespace echinus {

namespace {

bool both_signs(int i, int j, int k) {
    return std::min({i, j, k}) < 0 && std::max({i, j, k}) > 0;
}

/// Do the closed intervals [a, b] and [c, d], given in any order, overlap?
template <typename T>
bool overlap(T a, T b, T c, T d) {
    return std::max(std::min(a, b), std::min(c, d)) <= std::min(std::max(a, b), std::max(c, d));
}

// ---- Sides of a plane ----

/// Results of orientation(); 0 for corners that do not exist.
using Sides = std::array<int, 3>;

/// The sides of the plane of `b` on which the corners of `a` lie. All are 0 if `b` spans no plane.
Sides sides_of(const Simplex& a, const Simplex& b) {
    Sides sides{};
    if (b.count == 3)
        for (int i = 0; i < a.count; ++i)
            sides[i] = orientation(b.corners[0], b.corners[1], b.corners[2], a.corners[i]);
    return sides;
}

bool on_one_side(const Sides& sides, int count) {
    return sides[0] != 0 &&
           std::all_of(sides.begin() + 1, sides.begin() + count, [&](int side) { return side == sides[0]; });
}

// ---- In a plane ----

bool segments_meet(const Point2& p, const Point2& q, const Point2& r, const Point2& s) {
    const int r_side = orientation(p, q, r), s_side = orientation(p, q, s);
    if (r_side * s_side > 0) return false;
    const int p_side = orientation(r, s, p), q_side = orientation(r, s, q);
    if (p_side * q_side > 0) return false;
    const bool on_one_line = r_side == 0 && s_side == 0 && p_side == 0 && q_side == 0;
    return !on_one_line || (overlap(p.x, q.x, r.x, s.x) && overlap(p.y, q.y, r.y, s.y));
}

/// Do all corners of `b` lie strictly on the side of the line of an edge of `a` on which `a` has no corner?
bool edge_parts(const Simplex& a, const Simplex& b, int axis) {
    const auto seen = [axis](const Vec3f& p) { return seen_along(axis, p); };
    for (int i = 0; i < a.edge_count(); ++i) {
        const Point2 p = seen(a.corners[i]), q = seen(a.next(i));
        Sides sides{};
        for (int j = 0; j < b.count; ++j) sides[j] = orientation(p, q, seen(b.corners[j]));
        if (!on_one_side(sides, b.count)) continue;
        if (a.count < 3 || orientation(p, q, seen(a.corners[(i + 2) % 3])) != sides[0]) return true;
    }
    return false;
}

/// Convex figures, of which one has an area, are disjoint if and only if an edge of one separates them.
/// @pre one has an area
bool meet_in_plane(const Simplex& a, const Simplex& b, int axis) {
    return !edge_parts(a, b, axis) && !edge_parts(b, a, axis);
}

// ---- In space ----

bool segments_meet_in_space(const Vec3f& p, const Vec3f& q, const Vec3f& r, const Vec3f& s) {
    if (orientation(p, q, r, s) != 0) return false;
    std::optional<int> axis = axis_that_shows(p, q, r);
    if (!axis) axis = axis_that_shows(p, q, s);
    if (!axis) axis = axis_that_shows(r, s, p);
    if (!axis) // all on one line
        return overlap(p.x, q.x, r.x, s.x) && overlap(p.y, q.y, r.y, s.y) && overlap(p.z, q.z, r.z, s.z);
    return segments_meet(seen_along(*axis, p), seen_along(*axis, q), seen_along(*axis, r),
                         seen_along(*axis, s));
}

std::optional<int> axis_that_shows(const Simplex& s) {
    if (s.count < 3) return std::nullopt;
    return axis_that_shows(s.corners[0], s.corners[1], s.corners[2]);
}

/// @pre neither has an area
bool lines_meet(const Simplex& a, const Simplex& b) {
    for (int i = 0; i < a.edge_count(); ++i)
        for (int j = 0; j < b.edge_count(); ++j)
            if (segments_meet_in_space(a.corners[i], a.next(i), b.corners[j], b.next(j))) return true;
    return false;
}

/// @pre each lies in the other's plane, or the other spans no plane
bool meet_flat(const Simplex& a, const Simplex& b) {
    std::optional<int> axis = axis_that_shows(a);
    if (!axis) axis = axis_that_shows(b);
    return axis ? meet_in_plane(a, b, *axis) : lines_meet(a, b);
}

/// Does an edge of `a` that does not lie in the plane of `b` meet `b`?
bool edge_passes_through(const Simplex& a, const Sides& sides, const Simplex& b) {
    const auto& [r, s, t] = b.corners;
    for (int i = 0; i < a.edge_count(); ++i) {
        const int j = i + 1 < a.count ? i + 1 : 0;
        if (sides[i] * sides[j] > 0 || (sides[i] == 0 && sides[j] == 0)) continue;
        const Vec3f &p = a.corners[i], &q = a.corners[j];
        const int first = orientation(p, q, r, s), second = orientation(p, q, s, t);
        if (first * second < 0) continue;
        if (!both_signs(first, second, orientation(p, q, t, r))) return true;
    }
    return false;
}

} // namespace

std::optional<int> axis_that_shows(const Vec3f& a, const Vec3f& b, const Vec3f& c) noexcept {
    for (int axis : {2, 0, 1})
        if (orientation(seen_along(axis, a), seen_along(axis, b), seen_along(axis, c)) != 0) return axis;
    return std::nullopt;
}

bool simplices_meet(const Simplex& a, const Simplex& b) noexcept {
    const Sides a_sides = sides_of(a, b);
    if (on_one_side(a_sides, a.count)) return false;
    const Sides b_sides = sides_of(b, a);
    if (on_one_side(b_sides, b.count)) return false;
    if (a_sides == Sides{} && b_sides == Sides{}) return meet_flat(a, b);
    return edge_passes_through(a, a_sides, b) || edge_passes_through(b, b_sides, a);
}

} // namespace echinus
