// The steps that the kernels of this folder apply to a vector of particles. They are compiled once per
// instruction set. Each step gives the same bits as its scalar counterpart: it performs the same operations
// in the same order, without fused multiply-add.

#include "directions/bilinear_grid.hpp"
#include "geometry/elementary.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(ECHINUS_DISTANCE_MAP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#endif

#include "simd/lanes-inl.hpp"

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// atan2_polynomial() of geometry/elementary.hpp: the same operations in the same order, hence the same bits.
HWY_INLINE FloatLanes angle_of(FloatLanes y, FloatLanes x) {
    const FloatLanes ax = hn::Abs(x);
    const FloatLanes ay = hn::Abs(y);
    const FloatMask flat = hn::Gt(ax, ay);
    const FloatLanes larger = choose(flat, ax, ay);
    const FloatLanes smaller = choose(flat, ay, ax);
    const FloatLanes ratio = hn::IfThenElseZero(hn::Gt(larger, hn::Zero(kFloat)), hn::Div(smaller, larger));
    const FloatLanes s = hn::Mul(ratio, ratio);
    FloatLanes p = splat(kAtanCoefficients[0]);
    for (std::size_t i = 1; i < kAtanCoefficients.size(); ++i)
        p = hn::Add(hn::Mul(p, s), splat(kAtanCoefficients[i]));
    FloatLanes angle = hn::Mul(p, ratio);
    angle = choose(hn::Gt(ay, ax), hn::Sub(splat(kPi / 2), angle), angle);
    angle = choose(hn::Lt(x, hn::Zero(kFloat)), hn::Sub(splat(kPi), angle), angle);
    return hn::CopySign(angle, y);
}

/// turned_last() and turned_back() of directions/bilinear_grid.hpp.
HWY_INLINE PointLanes turned_last(PoleAxis axis, const PointLanes& v) {
    switch (axis) {
    case PoleAxis::X:
        return {v.y, v.z, v.x};
    case PoleAxis::Y:
        return {v.z, v.x, v.y};
    default:
        return v;
    }
}
HWY_INLINE PointLanes turned_back(PoleAxis axis, const PointLanes& v) {
    if (axis == PoleAxis::Z) return v;
    return turned_last(axis == PoleAxis::X ? PoleAxis::Y : PoleAxis::X, v);
}

HWY_INLINE IntLanes floor_to_int(FloatLanes value) {
    const IntLanes truncated = hn::ConvertTo(kInt, value);
    const FloatMask above = hn::Gt(hn::ConvertTo(kFloat, truncated), value);
    return hn::Add(truncated, hn::VecFromMask(kInt, as_int_mask(above))); // as a number, a mask is -1
}

using Rows = Columns<Floats>;

/// The same value for each corner of a cell.
template <typename OfCorner>
HWY_INLINE auto at_corners(const OfCorner& of_corner) {
    return std::array<decltype(of_corner(0)), 4>{of_corner(0), of_corner(1), of_corner(2), of_corner(3)};
}

/// Four neighbouring numbers of an array for each lane.
/// @param load_row  returns the four numbers starting at a position as hn::Vec<hn::FixedTag<float, 4>>
template <typename LoadRow>
HWY_INLINE Rows load_rows_at(const LoadRow& load_row, IntLanes positions) {
    HWY_ALIGN std::int32_t position[kLanes];
    hn::Store(positions, kInt, position);
    return load_rows(kFloat, [&](std::size_t lane) HWY_ATTR { return load_row(position[lane]); });
}

/// BilinearGrid for a vector of particles: the same members with the same bits.
class BilinearLanes {
  public:
    struct Place {
        FloatLanes u, v;
    };

    /// The cells whose two corners in each row are neighbours in the arrays.
    struct CornerRows {
        IntLanes lower, upper; ///< indices of the directions (0, 0) and (0, 1)
        FloatMask exist;
    };
    /// The values of the corners in the order of the rows, rearranged to that of a grid's corners(cell).
    static HWY_INLINE std::array<IntLanes, 4> corners_of_cell(const Place&,
                                                              const std::array<IntLanes, 4>& values) {
        return values;
    }

    static HWY_INLINE std::array<FloatLanes, 4> weights(const Place& at) {
        const FloatLanes left = hn::Sub(splat(1), at.u);
        const FloatLanes low = hn::Sub(splat(1), at.v);
        return {hn::Mul(left, low), hn::Mul(at.u, low), hn::Mul(left, at.v), hn::Mul(at.u, at.v)};
    }
    static HWY_INLINE IntLanes of_reference(const Place& at, const std::array<IntLanes, 4>& values) {
        const FloatMask right = hn::Gt(at.u, splat(0.5F));
        const FloatMask high = hn::Gt(at.v, splat(0.5F));
        return choose(high, choose(right, values[3], values[2]), choose(right, values[1], values[0]));
    }

    struct Derivatives {
        std::array<FloatLanes, 4> along_u, along_v;
    };
    static HWY_INLINE Derivatives weight_derivatives(const Place& at) {
        const FloatLanes one = splat(1);
        return {{hn::Sub(at.v, one), hn::Sub(one, at.v), hn::Neg(at.v), at.v},
                {hn::Sub(at.u, one), hn::Neg(at.u), hn::Sub(one, at.u), at.u}};
    }

    static HWY_INLINE FloatLanes interpolant(FloatLanes entry) { return entry; }
    template <typename Coordinates>
    static HWY_INLINE FloatLanes distance_of(FloatLanes interpolated, const Coordinates&) {
        return interpolated;
    }
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
