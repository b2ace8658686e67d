// Computes the distance between a vertex and a face or between two edges, and a plane between them: the plain
// functions, which are the specification, and kernels that process as many pairs at once as the instruction
// set has lanes.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/surfaces/separations.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simd/lanes-inl.hpp"
#include "simulation/surfaces/separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#ifndef ECHINUS_SIMULATION_SEPARATIONS_RULES
#define ECHINUS_SIMULATION_SEPARATIONS_RULES
namespace echinus {
namespace {

/// Compensates for the length of a rounded normal, and for the far smaller rounding in double.
constexpr double kRoundedDown = 1 - 1.0 / (1 << 20);

/// An upper bound for the rounding of a gap, as a share of the sum of the coordinates, which are relative to
/// one of the pair's points.
constexpr float kRounding = 1.0F / (1 << 20);

/// A direction between points is not trusted if their distance is less than this many times the rounding, or
/// if the gap along it is less than this share of the distance.
constexpr float kTrustedDistance = 64;
constexpr float kTrustedShare = 0.9F;

/// Pairs of one kind: their numbers, and their four points in separate arrays.
struct PairBatch {
    static constexpr std::size_t kMost = 64;
    std::array<std::array<std::uint32_t, kMost>, 4> points;
    std::array<std::uint32_t, kMost> numbers;
    std::size_t count = 0;

    void add(std::uint32_t number, const Pair& pair) {
        for (std::size_t k = 0; k < 4; ++k) points[k][count] = pair.points[k];
        numbers[count++] = number;
    }
    /// Fills up the arrays, so that whole vectors can be read.
    void pad() {
        for (std::array<std::uint32_t, kMost>& of_place : points)
            std::fill(of_place.begin() + static_cast<std::ptrdiff_t>(count), of_place.end(), of_place[0]);
    }
};

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

HWY_INLINE PointLanes gather(const PointArrays& points, IntLanes at) {
    return {hn::GatherIndex(kFloat, points.x.data(), at), hn::GatherIndex(kFloat, points.y.data(), at),
            hn::GatherIndex(kFloat, points.z.data(), at)};
}

HWY_INLINE FloatLanes at_least(FloatLanes a, FloatLanes b) {
    return hn::IfThenElse(a < b, b, a);
}
HWY_INLINE FloatLanes at_most(FloatLanes a, FloatLanes b) {
    return hn::IfThenElse(b < a, b, a);
}
HWY_INLINE FloatLanes clamped(FloatLanes value) {
    return at_most(at_least(value, splat(0)), splat(1));
}
/// a / b, or 0 if b is not positive.
HWY_INLINE FloatLanes ratio(FloatLanes a, FloatLanes b) {
    const FloatMask positive = b > splat(0);
    return hn::IfThenElse(positive, a / hn::IfThenElse(positive, b, splat(1)), splat(0));
}

using FourPoints = std::array<PointLanes, 4>;
using FourShares = std::array<FloatLanes, 4>;

/// nearest_of_segments().
HWY_INLINE FourShares nearest_of_segments(const FourPoints& p) {
    const PointLanes u = p[1] - p[0], v = p[3] - p[2], r = p[0] - p[2];
    const FloatLanes a = dot(u, u), b = dot(u, v), c = dot(u, r), e = dot(v, v), f = dot(v, r);
    const FloatLanes s = clamped(ratio(b * f - c * e, a * e - b * b));
    const FloatLanes wanted = ratio(b * s + f, e);
    const FloatLanes t = clamped(wanted);
    const FloatLanes end = clamped(ratio(b * t - c, a));
    const FloatLanes share = hn::IfThenElse(wanted == t, s, end);
    return {splat(1) - share, share, splat(1) - t, t};
}

/// nearest_of_triangle(), of p[corner], p[corner + 1] and p[corner + 2].
HWY_INLINE std::array<FloatLanes, 3> nearest_of_triangle(const PointLanes& p, const PointLanes& a,
                                                         const PointLanes& b, const PointLanes& c) {
    const PointLanes ab = b - a, ac = c - a, bc = c - b, ap = p - a, bp = p - b;
    const FloatLanes zero = splat(0), one = splat(1);
    const FloatLanes share_ab = clamped(ratio(dot(ab, ap), dot(ab, ab)));
    const FloatLanes share_ac = clamped(ratio(dot(ac, ap), dot(ac, ac)));
    const FloatLanes share_bc = clamped(ratio(dot(bc, bp), dot(bc, bc)));
    const PointLanes to_ab = ap - ab * share_ab, to_ac = ap - ac * share_ac, to_bc = bp - bc * share_bc;
    const FloatLanes ab_sq = dot(to_ab, to_ab), ac_sq = dot(to_ac, to_ac), bc_sq = dot(to_bc, to_bc);
    const PointLanes normal = cross(ab, ac);
    const FloatLanes at_b = dot(cross(ap, ac), normal), at_c = dot(cross(ab, ap), normal);
    const FloatLanes normal_sq = dot(normal, normal);
    const FloatMask above = hn::And(hn::And(at_b > zero, at_c > zero), at_b + at_c < normal_sq);
    const FloatMask on_ab = hn::And(ab_sq <= ac_sq, ab_sq <= bc_sq);
    const FloatMask on_ac = hn::AndNot(on_ab, ac_sq <= bc_sq);
    const FloatLanes edge_b = hn::IfThenElse(on_ab, share_ab, hn::IfThenElse(on_ac, zero, one - share_bc));
    const FloatLanes edge_c = hn::IfThenElse(on_ab, zero, hn::IfThenElse(on_ac, share_ac, share_bc));
    const FloatLanes share_b = hn::IfThenElse(above, ratio(at_b, normal_sq), edge_b);
    const FloatLanes share_c = hn::IfThenElse(above, ratio(at_c, normal_sq), edge_c);
    return {one - share_b - share_c, share_b, share_c};
}

template <PairKind kKind>
HWY_INLINE FourShares nearest_points(const FourPoints& p) {
    if constexpr (kKind == PairKind::EdgeEdge) {
        return nearest_of_segments(p);
    } else if constexpr (kKind == PairKind::VertexFace) {
        const auto face = nearest_of_triangle(p[0], p[1], p[2], p[3]);
        return {splat(1), face[0], face[1], face[2]};
    } else {
        const auto face = nearest_of_triangle(p[3], p[0], p[1], p[2]);
        return {face[0], face[1], face[2], splat(1)};
    }
}

/// separation(), except in cases that need careful_separation(): there the gap is negative.
template <PairKind kKind>
HWY_INLINE void separate_lanes(const PairBatch& batch, std::size_t first, const PointArrays& own,
                               const PointArrays& other, std::span<Separation> result) {
    constexpr std::size_t kOwn = own_count(kKind);
    FourPoints p;
    for (std::size_t k = 0; k < 4; ++k)
        p[k] = gather(k < kOwn ? own : other, load_indices(&batch.points[k][first]));
    const PointLanes base = p[0];
    FloatLanes extent = splat(0);
    for (PointLanes& point : p) {
        point = point - base;
        extent = at_least(extent, l1_norm(point));
    }
    const FloatLanes rounding = extent * splat(kRounding);
    const FourShares shares = nearest_points<kKind>(p);
    PointLanes direction = p[0] * shares[0];
    for (std::size_t k = 1; k < 4; ++k)
        direction = k < kOwn ? direction + p[k] * shares[k] : direction - p[k] * shares[k];
    const FloatLanes distance = length(direction);
    const PointLanes normal = direction * ratio(splat(1), distance);
    FloatLanes least = dot(normal, p[0]), most = dot(normal, p[kOwn]);
    for (std::size_t k = 1; k < kOwn; ++k) least = at_most(least, dot(normal, p[k]));
    for (std::size_t k = kOwn + 1; k < 4; ++k) most = at_least(most, dot(normal, p[k]));
    const FloatLanes gap = least - most - rounding;
    const FloatMask trusted =
        hn::And(distance > rounding * splat(kTrustedDistance), gap > distance * splat(kTrustedShare));
    std::array<std::array<float, kLanes>, 8> columns;
    const std::array<FloatLanes, 8> values{
        normal.x,  normal.y,  normal.z,  hn::IfThenElse(trusted, gap, splat(-1)),
        shares[0], shares[1], shares[2], shares[3]};
    for (std::size_t c = 0; c < 8; ++c) hn::StoreU(values[c], kFloat, columns[c].data());
    for (std::size_t lane = 0; lane < std::min(hn::Lanes(kFloat), batch.count - first); ++lane)
        result[batch.numbers[first + lane]] = {
            {columns[0][lane], columns[1][lane], columns[2][lane]},
            columns[3][lane],
            {columns[4][lane], columns[5][lane], columns[6][lane], columns[7][lane]}};
}

void separate_batches(const std::array<PairBatch, 3>& batches, const PointArrays& own,
                      const PointArrays& other, std::span<Separation> result) {
    const auto separate_all = [&]<PairKind kKind>(std::integral_constant<PairKind, kKind>) HWY_ATTR {
        const PairBatch& batch = batches[static_cast<std::size_t>(kKind)];
        for (std::size_t i = 0; i < batch.count; i += hn::Lanes(kFloat))
            separate_lanes<kKind>(batch, i, own, other, result);
    };
    separate_all(std::integral_constant<PairKind, PairKind::VertexFace>());
    separate_all(std::integral_constant<PairKind, PairKind::FaceVertex>());
    separate_all(std::integral_constant<PairKind, PairKind::EdgeEdge>());
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(separate_batches);

template <typename T>
T clamped(T value) {
    return value < 0 ? T{0} : value > 1 ? T{1} : value;
}

/// a / b, or 0 if b is not positive.
template <typename T>
T ratio(T a, T b) {
    return b > 0 ? a / b : T{0};
}

/// The shares of the ends of two segments in their nearest points (Ericson, Real-Time Collision Detection,
/// 2005, section 5.1.9).
template <typename T>
std::array<T, 4> nearest_of_segments(const std::array<Vec3<T>, 4>& p) {
    const Vec3<T> u = p[1] - p[0], v = p[3] - p[2], r = p[0] - p[2];
    const T a = dot(u, u), b = dot(u, v), c = dot(u, r), e = dot(v, v), f = dot(v, r);
    T s = clamped(ratio(b * f - c * e, a * e - b * b));
    const T wanted = ratio(b * s + f, e);
    const T t = clamped(wanted);
    if (wanted != t) s = clamped(ratio(b * t - c, a));
    return {1 - s, s, 1 - t, t};
}

/// The shares of a triangle's corners in its point nearest to p: if p is above the triangle, the foot of the
/// perpendicular, otherwise the nearest of the nearest points on its three edges.
template <typename T>
std::array<T, 3> nearest_of_triangle(const Vec3<T>& p, const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
    const Vec3<T> ab = b - a, ac = c - a, bc = c - b, ap = p - a, bp = p - b;
    const Vec3<T> normal = cross(ab, ac);
    const T at_b = dot(cross(ap, ac), normal), at_c = dot(cross(ab, ap), normal);
    const T normal_sq = dot(normal, normal);
    T share_b, share_c;
    if (at_b > 0 && at_c > 0 && at_b + at_c < normal_sq) {
        share_b = ratio(at_b, normal_sq);
        share_c = ratio(at_c, normal_sq);
    } else {
        const T share_ab = clamped(ratio(dot(ab, ap), dot(ab, ab)));
        const T share_ac = clamped(ratio(dot(ac, ap), dot(ac, ac)));
        const T share_bc = clamped(ratio(dot(bc, bp), dot(bc, bc)));
        const Vec3<T> to_ab = ap - ab * share_ab, to_ac = ap - ac * share_ac, to_bc = bp - bc * share_bc;
        const T ab_sq = dot(to_ab, to_ab), ac_sq = dot(to_ac, to_ac), bc_sq = dot(to_bc, to_bc);
        const bool on_ab = ab_sq <= ac_sq && ab_sq <= bc_sq, on_ac = !on_ab && ac_sq <= bc_sq;
        share_b = on_ab ? share_ab : on_ac ? T{0} : 1 - share_bc;
        share_c = on_ab ? T{0} : on_ac ? share_ac : share_bc;
    }
    return {1 - share_b - share_c, share_b, share_c};
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
Vec3<T> between(const std::array<Vec3<T>, 4>& p, const std::array<T, 4>& shares, std::size_t own) {
    Vec3<T> result = p[0] * shares[0];
    for (std::size_t k = 1; k < 4; ++k)
        result = k < own ? result + p[k] * shares[k] : result - p[k] * shares[k];
    return result;
}

/// Not inlined, because GCC 12 omits the rounding if it vectorises a conversion to float and back: the gap
/// would then be that of a different normal.
[[gnu::noinline]] Vec3f rounded(const Vec3d& v) {
    return Vec3f(v);
}

/// For cases in which the direction between computed nearest points is poor, because edges are nearly
/// parallel, a face is nearly a segment or the gap is tiny: tries every direction that can be the right one,
/// in double.
Separation careful_separation(PairKind kind, const std::array<Vec3f, 4>& points) {
    const std::size_t own = own_count(kind);
    std::array<Vec3d, 4> p;
    for (std::size_t k = 0; k < 4; ++k) p[k] = Vec3d(points[k]) - Vec3d(points[0]);
    const auto shares = nearest_points(kind, p);
    Separation best;
    for (std::size_t k = 0; k < 4; ++k) best.weights[k] = static_cast<float>(shares[k]);
    double best_gap = 0;
    const auto try_direction = [&](Vec3d direction) {
        const double size = length(direction);
        if (!(size > 0)) return;
        if (gap_along(direction, p, own) < gap_along(-direction, p, own)) direction = -direction;
        const Vec3f normal = rounded(direction * (1 / size));
        const double gap = gap_along(Vec3d(normal), p, own);
        if (!(gap > best_gap)) return;
        best_gap = gap;
        best.normal = normal;
    };
    try_direction(between(p, shares, own));
    for (std::size_t i = 0; i < own; ++i)
        for (std::size_t j = own; j < 4; ++j) try_direction(p[i] - p[j]);
    if (kind == PairKind::EdgeEdge) {
        try_direction(cross(p[1] - p[0], p[3] - p[2]));
        for (std::size_t k = 0; k < 4; ++k) { // from an end of one edge to the other edge
            const std::size_t a = k < 2 ? 2 : 0;
            const Vec3d along = p[a + 1] - p[a];
            try_direction(p[k] - (p[a] + along * clamped(ratio(dot(p[k] - p[a], along), dot(along, along)))));
        }
    } else {
        const std::size_t a = kind == PairKind::VertexFace ? 1 : 0;
        try_direction(cross(p[a + 1] - p[a], p[a + 2] - p[a]));
    }
    best.gap = static_cast<float>(best_gap * kRoundedDown);
    return best;
}

} // namespace

std::array<double, 4> nearest_points(PairKind kind, const std::array<Vec3d, 4>& points) noexcept {
    return nearest_points<double>(kind, points);
}

Separation separation(PairKind kind, const std::array<Vec3f, 4>& points) noexcept {
    const std::size_t own = own_count(kind);
    std::array<Vec3f, 4> p;
    float extent = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        p[k] = points[k] - points[0];
        extent = std::max(extent, std::fabs(p[k].x) + std::fabs(p[k].y) + std::fabs(p[k].z));
    }
    const float rounding = extent * kRounding;
    Separation result;
    result.weights = nearest_points(kind, p);
    const Vec3f direction = between(p, result.weights, own);
    const float distance = length(direction);
    result.normal = direction * ratio(1.0F, distance);
    result.gap = gap_along(result.normal, p, own) - rounding;
    const bool is_trusted = distance > rounding * kTrustedDistance && result.gap > distance * kTrustedShare;
    return is_trusted ? result : careful_separation(kind, points);
}

void separations(std::span<const Pair> pairs, const PointArrays& own, const PointArrays& other,
                 std::span<Separation> result) noexcept {
    const auto separate_one = [&](std::size_t i) {
        const Pair& pair = pairs[i];
        std::array<Vec3f, 4> points;
        for (std::size_t k = 0; k < 4; ++k)
            points[k] = (k < own_count(pair.kind) ? own : other)[pair.points[k]];
        result[i] = separation(pair.kind, points);
    };
    if (!use_kernels()) {
        for (std::size_t i = 0; i < pairs.size(); ++i) separate_one(i);
        return;
    }
    std::array<PairBatch, 3> batches;
    for (std::size_t first = 0; first < pairs.size(); first += PairBatch::kMost) {
        const std::size_t end = std::min(first + PairBatch::kMost, pairs.size());
        for (PairBatch& batch : batches) batch.count = 0;
        for (std::size_t i = first; i < end; ++i)
            batches[static_cast<std::size_t>(pairs[i].kind)].add(static_cast<std::uint32_t>(i), pairs[i]);
        for (PairBatch& batch : batches) batch.pad();
        ECHINUS_DISPATCH(separate_batches)(batches, own, other, result);
        for (std::size_t i = first; i < end; ++i)
            if (!(result[i].gap >= 0)) separate_one(i);
    }
}

} // namespace echinus
#endif // HWY_ONCE
