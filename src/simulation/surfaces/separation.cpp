#include "simulation/surfaces/separation.hpp"

#include <algorithm>
#include <cmath>

namespace echinus {

namespace {

template <typename T>
T clamped(T value) {
    return value < 0 ? T{0} : value > 1 ? T{1} : value;
}

/// The shares of the ends of two segments in their nearest points (Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.9).
template <typename T>
std::array<T, 4> nearest_of_segments(const std::array<Vec3<T>, 4>& p) {
    const Vec3<T> u = p[1] - p[0], v = p[3] - p[2], r = p[0] - p[2];
    const T a = dot(u, u), b = dot(u, v), c = dot(u, r), e = dot(v, v), f = dot(v, r);
    const T denominator = a * e - b * b;
    T s = denominator > 0 ? clamped((b * f - c * e) / denominator) : T{0};
    T t = e > 0 ? (b * s + f) / e : T{0};
    if (!(t >= 0 && t <= 1)) {
        t = t > 1 ? T{1} : T{0};
        s = a > 0 ? clamped((b * t - c) / a) : T{0};
    }
    return {1 - s, s, 1 - t, t};
}

/// The shares of a triangle's corners in its point nearest to p (Ericson, section 5.1.5).
template <typename T>
std::array<T, 3> nearest_of_triangle(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
    const Vec3<T> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const T d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const T d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const T d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const T vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const T share = d1 / (d1 - d3);
        return {1 - share, share, 0};
    }
    const T vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const T share = d2 / (d2 - d6);
        return {1 - share, 0, share};
    }
    const T va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const T share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - share, share};
    }
    const T sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

template <typename T>
std::array<T, 4> nearest_points(PairKind kind, const std::array<Vec3<T>, 4>& p) {
    if (kind == PairKind::EdgeEdge) return nearest_of_segments(p);
    if (kind == PairKind::VertexFace) {
        const auto face = nearest_of_triangle(p[0], p[1], p[2], p[3]);
        return {1, face[0], face[1], face[2]};
    }
    const auto face = nearest_of_triangle(p[3], p[0], p[1], p[2]);
    return {face[0], face[1], face[2], 1};
}

/// The gap along a direction, not yet divided by its length.
template <typename T>
T gap_along(const Vec3<T>& direction, const std::array<Vec3<T>, 4>& p, std::size_t own) {
    T least = dot(direction, p[0]);
    for (std::size_t k = 1; k < own; ++k) least = std::min(least, dot(direction, p[k]));
    T most = dot(direction, p[own]);
    for (std::size_t k = own + 1; k < 4; ++k) most = std::max(most, dot(direction, p[k]));
    return least - most;
}

template <typename T>
Vec3<T> between(const std::array<Vec3<T>, 4>& p, const std::array<T, 4>& weights, std::size_t own) {
    Vec3<T> result;
    for (std::size_t k = 0; k < 4; ++k) result += p[k] * (k < own ? weights[k] : -weights[k]);
    return result;
}

/// Makes up for the length of a rounded normal, and for the far smaller rounding in double.
constexpr double kRoundedDown = 1 - 1.0 / (1 << 20);

/// More than the rounding of a gap between places whose coordinates, taken from one of them, are this large.
float rounding_of(const std::array<Vec3f, 4>& p) {
    float extent = 0;
    for (const Vec3f& point : p)
        extent = std::max(extent, std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z));
    return extent * (1.0F / (1 << 20));
}

/// Where the direction between computed nearest points is poor, because edges are nearly parallel, a face is
/// nearly a segment or the gap is tiny: in double, along every direction that can be the right one.
Separation careful_separation(PairKind kind, const std::array<Vec3f, 4>& points) {
    const std::size_t own = own_count(kind);
    std::array<Vec3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = Vec3d(points[k]) - Vec3d(points[0]);
    const auto weights = nearest_points(kind, p);
    Separation best;
    for (std::size_t k = 0; k < 4; ++k) best.weights[k] = static_cast<float>(weights[k]);
    double best_gap = 0;
    const auto try_direction = [&](Vec3d direction) {
        const double size = length(direction);
        if (!(size > 0)) return;
        if (gap_along(direction, p, own) < gap_along(-direction, p, own)) direction = -direction;
        const Vec3f normal(direction * (1 / size));
        const double gap = gap_along(Vec3d(normal), p, own);
        if (!(gap > best_gap)) return;
        best_gap = gap;
        best.normal = normal;
    };
    try_direction(between(p, weights, own));
    for (std::size_t i = 0; i < own; ++i)
        for (std::size_t j = own; j < 4; ++j) try_direction(p[i] - p[j]);
    if (kind == PairKind::EdgeEdge) {
        try_direction(cross(p[1] - p[0], p[3] - p[2]));
        for (std::size_t k = 0; k < 4; ++k) { // from an end to the other edge
            const std::size_t a = k < 2 ? 2 : 0;
            const Vec3d along = p[a + 1] - p[a];
            const double size_sq = dot(along, along);
            const double share = size_sq > 0 ? clamped(dot(p[k] - p[a], along) / size_sq) : 0;
            try_direction(p[k] - (p[a] + along * share));
        }
    } else {
        const std::size_t a = kind == PairKind::VertexFace ? 1 : 0;
        try_direction(cross(p[a + 1] - p[a], p[a + 2] - p[a]));
    }
    best.gap = static_cast<float>(best_gap * kRoundedDown);
    return best;
}

} // namespace

Separation separation(PairKind kind, const std::array<Vec3f, 4>& points) {
    const std::size_t own = own_count(kind);
    std::array<Vec3f, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = points[k] - points[0];
    const float rounding = rounding_of(p);
    Separation result;
    result.weights = nearest_points(kind, p);
    const Vec3f direction = between(p, result.weights, own);
    const float distance = length(direction);
    if (distance > 64 * rounding) {
        result.normal = direction * (1 / distance);
        result.gap = gap_along(result.normal, p, own) - rounding;
        if (result.gap > 0.9F * distance) return result;
    }
    return careful_separation(kind, points);
}

} // namespace echinus
