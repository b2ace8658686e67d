#include "exact_map/query/triangle_distance.hpp"

#include <algorithm>
#include <limits>

namespace echinus {

namespace {

/// The shortest vector found so far between points of two triangles a and b.
struct Shortest {
    Vec3d vector; ///< from b to a
    double length_sq = std::numeric_limits<double>::infinity();

    void offer(const Vec3d& candidate) {
        const double candidate_sq = dot(candidate, candidate);
        if (!(candidate_sq < length_sq)) return;
        vector = candidate;
        length_sq = candidate_sq;
    }
};

/// The shortest vector between two segments, from p along u and from q along v (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.9).
Vec3d between_segments(const Vec3d& p, const Vec3d& u, const Vec3d& q, const Vec3d& v) {
    const Vec3d r = p - q;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), ur = dot(u, r), vr = dot(v, r);
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 0 ? clamp01((uv * vr - ur * vv) / determinant) : 0;
    double t = vv > 0 ? (uv * s + vr) / vv : 0;
    if (!(t >= 0 && t <= 1)) {
        t = t > 1 ? 1 : 0;
        s = uu > 0 ? clamp01((uv * t - ur) / uu) : 0;
    }
    return r + u * s - v * t;
}

/// Offers the vector from the plane of a triangle to a point above its interior. Otherwise, and for a
/// triangle without area, an edge is nearer.
template <typename Offer>
void offer_height(const TriangleCorners& triangle, const Vec3d& normal, const Vec3d& point,
                  const Offer& offer) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!(dot(cross(triangle[(k + 1) % 3] - triangle[k], point - triangle[k]), normal) > 0)) return;
    offer(normal * (dot(point - triangle[0], normal) / dot(normal, normal)));
}

Vec3d normal_of(const TriangleCorners& t) {
    return cross(t[1] - t[0], t[2] - t[1]);
}

Vec3d shortest_between(const TriangleCorners& a, const TriangleCorners& b) {
    Shortest shortest;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            shortest.offer(between_segments(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]));
    const Vec3d a_normal = normal_of(a), b_normal = normal_of(b);
    for (std::size_t k = 0; k < 3; ++k) {
        offer_height(b, b_normal, a[k], [&](const Vec3d& v) { shortest.offer(v); });
        offer_height(a, a_normal, b[k], [&](const Vec3d& v) { shortest.offer(-v); });
    }
    return shortest.vector;
}

/// The distance between the triangles along a direction of any length, from b towards a; negative if they
/// overlap along it.
double gap_along(const Vec3d& direction, const TriangleCorners& a, const TriangleCorners& b) {
    const double size = length(direction);
    if (!(size > 0)) return 0;
    const double low = std::min({dot(direction, a[0]), dot(direction, a[1]), dot(direction, a[2])});
    const double high = std::max({dot(direction, b[0]), dot(direction, b[1]), dot(direction, b[2])});
    return (low - high) / size;
}

/// Tries every direction that can be the right one if nearest points are ill-determined because edges are
/// nearly parallel or triangles are slivers.
TriangleGap careful_gap(const TriangleCorners& a, const TriangleCorners& b) {
    TriangleGap widest;
    const auto try_one = [&](const Vec3d& direction) {
        const double width = gap_along(direction, a, b);
        if (width > widest.width) widest = {direction, width};
    };
    const auto try_both = [&](const Vec3d& direction) {
        try_one(direction);
        try_one(-direction);
    };
    try_both(normal_of(a));
    try_both(normal_of(b));
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3d u = a[(i + 1) % 3] - a[i], v = b[(j + 1) % 3] - b[j];
            try_both(cross(u, v));
            try_both(cross(cross(u, b[j] - a[i]), u)); // perpendicular to the edge of a, towards b's corner
            try_both(cross(cross(v, a[i] - b[j]), v));
            try_both(b[j] - a[i]);
        }
    return widest;
}

} // namespace

TriangleGap gap_between(const TriangleCorners& a, const TriangleCorners& b) noexcept {
    const Vec3d& origin = b[0];
    const TriangleCorners near_a{a[0] - origin, a[1] - origin, a[2] - origin};
    const TriangleCorners near_b{Vec3d{}, b[1] - origin, b[2] - origin};
    const Vec3d shortest = shortest_between(near_a, near_b);
    constexpr double kGood = 1 - 0x1p-20;
    const TriangleGap gap{shortest, gap_along(shortest, near_a, near_b)};
    if (gap.width >= length(shortest) * kGood) return gap;
    const TriangleGap careful = careful_gap(near_a, near_b);
    return careful.width > gap.width ? careful : gap;
}

double distance_from_below(const TriangleCorners& a, const TriangleCorners& b, double rounding) noexcept {
    return std::max(gap_between(a, b).width - rounding, 0.0);
}

namespace {

struct Edge {
    std::size_t start, end; ///< corner numbers
    double difference;      ///< the length of the difference of their displacements
};

/// The edge whose endpoints differ most in their displacements.
Edge widest_apart(const TriangleCorners& way) {
    Edge widest{0, 1, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge{k, (k + 1) % 3, length(way[(k + 1) % 3] - way[k])};
        if (edge.difference > widest.difference) widest = edge;
    }
    return widest;
}

MovingTriangle half_of(const MovingTriangle& whole, std::size_t kept, std::size_t other) {
    MovingTriangle half = whole;
    half.from[other] = (whole.from[kept] + whole.from[other]) * 0.5;
    half.way[other] = (whole.way[kept] + whole.way[other]) * 0.5;
    return half;
}

/// How long it takes until a corner reaches the plane that bounds a gap on the side of the stationary
/// triangle.
double time_to_plane(const TriangleCorners& moving, const TriangleCorners& way,
                     const TriangleCorners& standing, const Vec3d& direction, double rounding) {
    const Vec3d unit = direction * (1 / length(direction));
    const Vec3d& origin = standing[0];
    const double plane =
        std::max({0.0, dot(unit, standing[1] - origin), dot(unit, standing[2] - origin)}) + rounding;
    double time = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const double speed = -dot(unit, way[k]);
        if (speed > 0) time = std::min(time, (dot(unit, moving[k] - origin) - plane) / speed);
    }
    return time * (1 - 0x1p-40);
}

} // namespace

std::optional<double> arrival(const MovingTriangle& moving, const TriangleCorners& standing, double start,
                              double last, const ArrivalTolerance& tolerance) noexcept {
    constexpr int kMovesOfWhole = 8;
    double time = start;
    for (int move = 1; time <= last; ++move) {
        const TriangleCorners now = moving.at(time);
        const double rounding = rounding_of(now, tolerance.rounded_extent);
        const TriangleGap gap = gap_between(now, standing);
        if (gap.width - rounding <= tolerance.reach) return time;
        time += time_to_plane(now, moving.way, standing, gap.direction, rounding);
        if (move < kMovesOfWhole || time > last) continue;
        const Edge edge = widest_apart(moving.way);
        if (edge.difference * (last - time) <= tolerance.reach / 2) continue;
        const auto first = arrival(half_of(moving, edge.start, edge.end), standing, time, last, tolerance);
        const auto second =
            arrival(half_of(moving, edge.end, edge.start), standing, time, first.value_or(last), tolerance);
        return second ? second : first;
    }
    return std::nullopt;
}

} // namespace echinus
