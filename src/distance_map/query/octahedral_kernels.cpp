#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/octahedral_kernels.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane

/// OctahedralGrid for a vector of particles: the same members with the same bits.
class OctahedralLanes {
  public:
    explicit OctahedralLanes(const DistanceMapView& map)
        : n_(static_cast<std::int32_t>(map.divisions)), width_(2 * n_ + 1),
          n_float_(static_cast<float>(map.divisions)), least_(map.radius * 0x1p-20F) {}

    HWY_INLINE PointLanes to_grid(const PointLanes& v) const { return v; }
    HWY_INLINE PointLanes from_grid(const PointLanes& v) const { return v; }

    struct Coordinates {
        FloatLanes along_u, along_v, stretch;
    };

    HWY_INLINE Coordinates coordinates_of(const PointLanes& d) const {
        const FloatLanes zero = hn::Zero(kFloat);
        const FloatLanes n = splat(n_float_);
        const FloatLanes ax = hn::Abs(d.x);
        const FloatLanes ay = hn::Abs(d.y);
        const FloatLanes l1 = l1_norm(d);
        const FloatMask off_centre = hn::Gt(l1, zero);
        const FloatLanes scale = hn::IfThenElseZero(off_centre, hn::Div(n, l1));
        const FloatLanes x = hn::Min(hn::Mul(ax, scale), n);
        const FloatLanes y = hn::Min(hn::Mul(ay, scale), n);
        const FloatMask below = hn::Lt(d.z, zero);
        const FloatLanes u = choose(below, hn::Sub(n, y), x);
        const FloatLanes v = choose(below, hn::Sub(n, x), y);
        return {hn::Add(n, hn::CopySign(u, d.x)), hn::Add(n, hn::CopySign(v, d.y)),
                choose(off_centre, hn::Div(length(d), l1), splat(1))};
    }

    struct Cell {
        IntLanes i, j;
        FloatLanes u, v, rest;
        FloatMask mirrored, beyond;
    };

    /// @param wanted  other lanes get an arbitrary valid cell
    HWY_INLINE Cell cell_at(const Coordinates& at, FloatMask wanted) const {
        const FloatLanes along_u = hn::IfThenElseZero(wanted, at.along_u);
        const FloatLanes along_v = hn::IfThenElseZero(wanted, at.along_v);
        const IntLanes last = splat_int(2 * n_ - 1);
        const IntLanes i = hn::Min(hn::ConvertTo(kInt, along_u), last);
        const IntLanes j = hn::Min(hn::ConvertTo(kInt, along_v), last);
        Cell cell{i,
                  j,
                  hn::Sub(along_u, hn::ConvertTo(kFloat, i)),
                  hn::Sub(along_v, hn::ConvertTo(kFloat, j)),
                  splat(0),
                  wanted,
                  wanted};
        cell.mirrored = hn::Xor(is_right(cell), is_upper(cell));
        cell.rest = hn::Sub(choose(cell.mirrored, cell.u, hn::Sub(splat(1), cell.u)), cell.v);
        cell.beyond = hn::Lt(cell.rest, hn::Zero(kFloat));
        return cell;
    }

    HWY_INLINE std::array<IntLanes, 4> corners(const Cell& cell) const {
        const IntLanes first = hn::Add(hn::Mul(cell.j, splat_int(width_)), cell.i);
        const IntLanes second = hn::Add(first, splat_int(1));
        const IntLanes third = hn::Add(first, splat_int(width_));
        const IntLanes fourth = hn::Add(third, splat_int(1));
        return corners_of_cell(cell, {first, second, third, fourth});
    }

    /// Replaces the value of the corner outside the triangle: see OctahedralGrid::Cell::doubled().
    static HWY_INLINE std::array<IntLanes, 4> corners_of_cell(const Cell& cell,
                                                              const std::array<IntLanes, 4>& values) {
        const IntLanes other = choose(cell.mirrored, values[0], values[1]);
        const FloatMask near = hn::Not(cell.beyond);
        return {choose(hn::AndNot(cell.mirrored, cell.beyond), other, values[0]),
                choose(hn::And(cell.mirrored, cell.beyond), other, values[1]),
                choose(hn::And(cell.mirrored, near), other, values[2]),
                choose(hn::AndNot(cell.mirrored, near), other, values[3])};
    }

    struct CornerRows {
        IntLanes lower, upper;
        FloatMask exist;
    };
    HWY_INLINE CornerRows corner_rows(const Cell& cell) const {
        const IntLanes lower = hn::Add(hn::Mul(cell.j, splat_int(width_)), cell.i);
        return {lower, hn::Add(lower, splat_int(width_)), splat_mask(true)};
    }

    HWY_INLINE std::array<FloatLanes, 4> weights(const Cell& cell) const {
        const FloatLanes one = splat(1);
        const FloatLanes u = choose(cell.mirrored, hn::Sub(one, cell.u), cell.u);
        const FloatLanes w0 = hn::IfThenElseZero(hn::Not(cell.beyond), cell.rest);
        const FloatLanes w1 = choose(cell.beyond, hn::Sub(one, cell.v), u);
        const FloatLanes w2 = choose(cell.beyond, hn::Sub(one, u), cell.v);
        const FloatLanes w3 = hn::IfThenElseZero(cell.beyond, hn::Neg(cell.rest));
        return unmirrored(cell, {w0, w1, w2, w3});
    }

    HWY_INLINE IntLanes of_reference(const Cell& cell, const std::array<IntLanes, 4>& values) const {
        const std::array<FloatLanes, 4> w = weights(cell);
        FloatLanes best = w[0];
        IntLanes chosen = values[0];
        for (std::size_t corner = 1; corner < 4; ++corner) {
            const FloatMask heavier = hn::Gt(w[corner], best);
            best = choose(heavier, w[corner], best);
            chosen = choose(heavier, values[corner], chosen);
        }
        return chosen;
    }

    struct Derivatives {
        std::array<FloatLanes, 4> along_u, along_v;
    };
    HWY_INLINE Derivatives weight_derivatives(const Cell& cell) const {
        const FloatLanes near = hn::IfThenElseZero(hn::Not(cell.beyond), splat(1));
        const FloatLanes far = hn::Sub(splat(1), near);
        const FloatLanes minus_near = hn::Neg(near);
        const FloatLanes minus_far = hn::Neg(far);
        const std::array<FloatLanes, 4> v = unmirrored(cell, {minus_near, minus_far, near, far});
        const std::array<FloatLanes, 4> u = unmirrored(cell, {minus_near, near, minus_far, far});
        return {{sign_of_mirror(cell, u[0]), sign_of_mirror(cell, u[1]), sign_of_mirror(cell, u[2]),
                 sign_of_mirror(cell, u[3])},
                v};
    }

    HWY_INLINE FloatLanes interpolant(FloatLanes entry) const {
        return hn::Div(splat(1), hn::Max(entry, splat(least_)));
    }
    static HWY_INLINE FloatLanes distance_of(FloatLanes interpolated, const Coordinates& at) {
        return hn::Div(at.stretch, interpolated);
    }

    HWY_INLINE PointLanes surface_gradient(const PointLanes&, const Cell& cell, FloatLanes distance,
                                           FloatLanes value, FloatLanes slope_u, FloatLanes slope_v) const {
        const FloatLanes n = splat(n_float_);
        const IntLanes from_middle_i = hn::Sub(cell.i, splat_int(n_));
        const IntLanes from_middle_j = hn::Sub(cell.j, splat_int(n_));
        const FloatLanes x = hn::Add(hn::ConvertTo(kFloat, from_middle_i), cell.u);
        const FloatLanes y = hn::Add(hn::ConvertTo(kFloat, from_middle_j), cell.v);
        const FloatMask right = is_right(cell);
        const FloatMask upper = is_upper(cell);
        const FloatLanes sign_x = choose(right, splat(1), splat(-1));
        const FloatLanes sign_y = choose(upper, splat(1), splat(-1));
        const IntLanes minus_one = splat_int(-1);
        const IntLanes across = hn::Add(choose(right, from_middle_i, hn::Sub(minus_one, from_middle_i)),
                                        choose(upper, from_middle_j, hn::Sub(minus_one, from_middle_j)));
        const FloatMask towards_middle = hn::Xor(upper, cell.beyond);
        const IntLanes far_corner = choose(towards_middle, across, hn::Add(across, splat_int(1)));
        const FloatMask below = as_mask(hn::Gt(far_corner, splat_int(n_ - 1)));
        const FloatLanes at_middle = hn::Sub(hn::Sub(value, hn::Mul(slope_u, x)), hn::Mul(slope_v, y));
        const FloatLanes slopes = hn::Add(hn::Mul(sign_x, slope_u), hn::Mul(sign_y, slope_v));
        const PointLanes m{hn::Add(hn::Mul(sign_x, at_middle), hn::Mul(n, slope_u)),
                           hn::Add(hn::Mul(sign_y, at_middle), hn::Mul(n, slope_v)),
                           choose(below, hn::Neg(hn::Add(at_middle, hn::Mul(n, slopes))), at_middle)};
        return m * distance;
    }

  private:
    HWY_INLINE FloatMask is_right(const Cell& cell) const {
        return as_mask(hn::Gt(cell.i, splat_int(n_ - 1)));
    }
    HWY_INLINE FloatMask is_upper(const Cell& cell) const {
        return as_mask(hn::Gt(cell.j, splat_int(n_ - 1)));
    }

    static HWY_INLINE std::array<FloatLanes, 4> unmirrored(const Cell& cell,
                                                           const std::array<FloatLanes, 4>& w) {
        return {choose(cell.mirrored, w[1], w[0]), choose(cell.mirrored, w[0], w[1]),
                choose(cell.mirrored, w[3], w[2]), choose(cell.mirrored, w[2], w[3])};
    }
    static HWY_INLINE FloatLanes sign_of_mirror(const Cell& cell, FloatLanes value) {
        return choose(cell.mirrored, hn::Neg(value), value);
    }

    std::int32_t n_, width_;
    float n_float_, least_;
};

#endif

GridKernels octahedral() {
    return kernels_of<OctahedralLanes>();
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

HWY_EXPORT(octahedral);

GridKernels octahedral_kernels() noexcept {
    return ECHINUS_DISPATCH(octahedral)();
}

} // namespace echinus
#endif
