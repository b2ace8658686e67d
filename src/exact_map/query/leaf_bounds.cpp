#include "exact_map/query/leaf_bounds.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/leaf_bounds.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "simd/dispatch.hpp"
#include "simd/vec3_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

namespace {

using Faces = hn::CappedTag<float, TreeNode::kWidth>;
using Lanes = hn::Vec<Faces>;
using Points = Vec3Lanes<Lanes>;
constexpr Faces kFaces;

HWY_INLINE Lanes all(float value) {
    return hn::Set(kFaces, value);
}
HWY_INLINE Points all(const Vec3f& v) {
    return {all(v.x), all(v.y), all(v.z)};
}
HWY_INLINE Lanes clamped(Lanes share) {
    return hn::Min(hn::Max(share, all(0)), all(1));
}
/// The reciprocal; 0 for 0.
HWY_INLINE Lanes inverse(Lanes value) {
    return hn::IfThenElseZero(hn::Gt(value, all(0)), hn::Div(all(1), value));
}
HWY_INLINE Points along(const Points& start, const Points& way, Lanes share) {
    return {hn::MulAdd(way.x, share, start.x), hn::MulAdd(way.y, share, start.y),
            hn::MulAdd(way.z, share, start.z)};
}

/// A triangle's corners, edges and normal.
struct Shape {
    Points corners[3], edges[3], normal;
    Lanes edge_inverses[3], normal_inverse;

    HWY_INLINE Shape(const Points& a, const Points& b, const Points& c)
        : corners{a, b, c}, edges{b - a, c - b, a - c},
          normal(fused_cross(edges[0], edges[1])), edge_inverses{inverse(fused_dot(edges[0], edges[0])),
                                                                 inverse(fused_dot(edges[1], edges[1])),
                                                                 inverse(fused_dot(edges[2], edges[2]))},
          normal_inverse(plane_inverse()) {}

    /// 1 / normal^2, or 0 for a triangle so thin that its plane is ill-determined, with |u| |v| / |u x v|
    /// above 32 at the sharpest corner. No point counts as above such a triangle.
    HWY_INLINE Lanes plane_inverse() const {
        const Lanes ab = fused_dot(edges[0], edges[0]), bc = fused_dot(edges[1], edges[1]),
                    ca = fused_dot(edges[2], edges[2]);
        const Lanes sides_sq = hn::Max(hn::Max(hn::Mul(ab, bc), hn::Mul(bc, ca)), hn::Mul(ca, ab));
        const Lanes normal_sq = fused_dot(normal, normal);
        return hn::IfThenElseZero(hn::Lt(sides_sq, hn::Mul(normal_sq, all(1024))), inverse(normal_sq));
    }
};

struct Shortest {
    Points vector; ///< from the face to the triangle
    Lanes length_sq;

    HWY_INLINE void offer(const Points& candidate, Lanes candidate_sq) {
        vector = choose(hn::Lt(candidate_sq, length_sq), candidate, vector);
        length_sq = hn::Min(candidate_sq, length_sq);
    }

    /// Offers the vector between edge i of the triangle and edge j of the face, as in triangle_distance.cpp.
    HWY_INLINE void offer_edges(const Shape& triangle, const Shape& face, int i, int j) {
        const Points &u = triangle.edges[i], &v = face.edges[j];
        const Points r = triangle.corners[i] - face.corners[j];
        const Lanes uu = fused_dot(u, u), uv = fused_dot(u, v), vv = fused_dot(v, v);
        const Lanes ur = fused_dot(u, r), vr = fused_dot(v, r);
        const Lanes determinant = hn::MulSub(uu, vv, hn::Mul(uv, uv));
        const Lanes first = clamped(hn::Mul(hn::MulSub(uv, vr, hn::Mul(ur, vv)), inverse(determinant)));
        const Lanes t = clamped(hn::Mul(hn::MulAdd(uv, first, vr), face.edge_inverses[j]));
        const Lanes s = clamped(hn::Mul(hn::MulSub(uv, t, ur), triangle.edge_inverses[i]));
        const Points candidate = along(along(r, u, s), -v, t);
        offer(candidate, fused_dot(candidate, candidate));
    }

    /// Offers the vector between the plane of a shape and a point above its interior.
    HWY_INLINE void offer_height(const Shape& shape, const Points& point, Lanes sign) {
        auto inside = hn::Gt(shape.normal_inverse, all(0));
        for (int k = 0; k < 3; ++k) {
            const Points side = fused_cross(shape.edges[k], point - shape.corners[k]);
            inside = hn::And(inside, hn::Gt(fused_dot(side, shape.normal), all(0)));
        }
        const Lanes height =
            hn::Mul(hn::Mul(fused_dot(point - shape.corners[0], shape.normal), shape.normal_inverse), sign);
        const Points candidate = shape.normal * height;
        offer(candidate, hn::IfThenElse(inside, fused_dot(candidate, candidate), all(kFar)));
    }

    static constexpr float kFar = 1e30F;
};

/// Squared gaps between the triangle's box and the boxes of the faces.
HWY_INLINE Lanes box_gaps_sq(const NearTriangle& triangle, const Points& a, const Points& b,
                             const Points& c) {
    const auto gap = [](Lanes p, Lanes q, Lanes r, float low, float high) HWY_ATTR {
        const Lanes above = hn::Sub(hn::Min(hn::Min(p, q), r), all(high));
        const Lanes below = hn::Sub(all(low), hn::Max(hn::Max(p, q), r));
        return hn::Max(hn::Max(above, below), all(0));
    };
    const Points gaps{gap(a.x, b.x, c.x, triangle.low.x, triangle.high.x),
                      gap(a.y, b.y, c.y, triangle.low.y, triangle.high.y),
                      gap(a.z, b.z, c.z, triangle.low.z, triangle.high.z)};
    // Allows for the rounding of corners and sums.
    return hn::Mul(fused_dot(gaps, gaps), all(1 - 0x1p-20F));
}

/// Rounding. Let S be the sum of all absolute coordinates. Whichever direction was computed, the gap along it
/// is off by less than 2^-21 S. A vector between two edges differs by as much from one between two of their
/// points; a height is off by 32 times as much, by the choice of the planes that are used.
struct Bounds {
    Lanes lower, upper;

    HWY_INLINE Bounds(const Shape& triangle, const Shape& face) : lower(all(0)), upper(all(0)) {
        Shortest shortest{triangle.corners[0], all(Shortest::kFar)};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) shortest.offer_edges(triangle, face, i, j);
        for (int k = 0; k < 3; ++k) {
            shortest.offer_height(face, triangle.corners[k], all(1));
            shortest.offer_height(triangle, face.corners[k], all(-1));
        }
        const Points& n = shortest.vector;
        const auto level = [&](const Points& p) HWY_ATTR { return fused_dot(n, p); };
        const Lanes low = hn::Min(hn::Min(level(triangle.corners[0]), level(triangle.corners[1])),
                                  level(triangle.corners[2]));
        const Lanes high =
            hn::Max(hn::Max(level(face.corners[0]), level(face.corners[1])), level(face.corners[2]));
        const Lanes size = hn::Sqrt(shortest.length_sq);
        Lanes sum = all(0);
        for (const Shape* shape : {&triangle, &face})
            for (const Points& corner : shape->corners) sum = hn::Add(sum, l1_norm(corner));
        const Lanes gap = hn::Mul(hn::Sub(low, high), inverse(size));
        lower = hn::Max(hn::Sub(gap, hn::Mul(sum, all(0x1p-19F))), all(0));
        upper = hn::Add(size, hn::Mul(sum, all(0x1p-14F)));
    }
};

} // namespace

bool bound_leaf_distances(const ExactMapView& map, const LeafFaces& faces, const NearTriangle& triangle,
                          float reach_sq, LeafBounds& bounds) {
    constexpr std::size_t kWidth = TreeNode::kWidth;
    alignas(64) std::array<std::array<float, kWidth>, 9> rows;
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
        const std::size_t face = std::min(faces.first + lane, faces.last - 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3<std::int32_t> corner = map.vertices[map.corners[3 * face + k]] - triangle.origin;
            rows[3 * k][lane] = static_cast<float>(corner.x);
            rows[3 * k + 1][lane] = static_cast<float>(corner.y);
            rows[3 * k + 2][lane] = static_cast<float>(corner.z);
        }
    }
    bool any = false;
    for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(kFaces)) {
        const auto corner = [&](std::size_t k) HWY_ATTR {
            return Points{hn::Load(kFaces, &rows[3 * k][lane]), hn::Load(kFaces, &rows[3 * k + 1][lane]),
                          hn::Load(kFaces, &rows[3 * k + 2][lane])};
        };
        const Points a = corner(0), b = corner(1), c = corner(2);
        const auto near = hn::Le(box_gaps_sq(triangle, a, b, c), all(reach_sq));
        Lanes lower = all(std::numeric_limits<float>::infinity()), upper = lower;
        if (!hn::AllFalse(kFaces, near)) {
            any = true;
            const Bounds found(
                Shape(all(triangle.corners[0]), all(triangle.corners[1]), all(triangle.corners[2])),
                Shape(a, b, c));
            lower = hn::IfThenElse(near, found.lower, lower);
            upper = found.upper;
        }
        hn::Store(lower, kFaces, &bounds.lower[lane]);
        hn::Store(upper, kFaces, &bounds.upper[lane]);
    }
    return any;
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(bound_leaf_distances);

} // namespace

bool bound_leaf_distances(const ExactMapView& map, const LeafFaces& faces, const NearTriangle& triangle,
                          float reach_sq, LeafBounds& bounds) noexcept {
    return ECHINUS_DISPATCH(bound_leaf_distances)(map, faces, triangle, reach_sq, bounds);
}

} // namespace echinus
#endif
