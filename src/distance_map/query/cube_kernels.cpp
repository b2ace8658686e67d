#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/cube_kernels.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane

/// CubeGrid for a vector of particles: the same members with the same bits.
class CubeLanes : public BilinearLanes {
  public:
    explicit CubeLanes(const DistanceMapView& map)
        : n_(static_cast<std::int32_t>(map.divisions)), width_(n_ + 1),
          n_float_(static_cast<float>(map.divisions)), per_angle_(2 * n_float_ / kPi) {}

    HWY_INLINE PointLanes to_grid(const PointLanes& v) const { return v; }
    HWY_INLINE PointLanes from_grid(const PointLanes& v) const { return v; }

    struct Side {
        FloatMask is_x, is_y; ///< z if neither
        FloatMask negative;
    };
    struct Coordinates {
        FloatLanes along_u, along_v;
        Side side;
    };

    HWY_INLINE Coordinates coordinates_of(const PointLanes& d) const {
        const Side side = side_of(d);
        const PointLanes s = to_side(side, d);
        const FloatLanes m = hn::Abs(s.z);
        return {along(s.x, m), along(s.y, m), side};
    }

    struct Cell : Place {
        IntLanes first; ///< index of the direction (0, 0)
        Side side;
    };

    /// @param wanted  other lanes get an arbitrary valid cell
    HWY_INLINE Cell cell_at(const Coordinates& at, FloatMask wanted) const {
        const FloatLanes along_u = hn::IfThenElseZero(wanted, at.along_u);
        const FloatLanes along_v = hn::IfThenElseZero(wanted, at.along_v);
        const IntLanes last = splat_int(n_ - 1);
        const IntLanes i = hn::Max(hn::Min(hn::ConvertTo(kInt, along_u), last), hn::Zero(kInt));
        const IntLanes j = hn::Max(hn::Min(hn::ConvertTo(kInt, along_v), last), hn::Zero(kInt));
        const IntLanes axis =
            choose(at.side.is_x, hn::Zero(kInt), choose(at.side.is_y, splat_int(2), splat_int(4)));
        const IntLanes side = hn::Add(axis, choose(at.side.negative, splat_int(1), hn::Zero(kInt)));
        const IntLanes row = hn::Add(hn::Mul(side, splat_int(width_)), j);
        return {{hn::Sub(along_u, hn::ConvertTo(kFloat, i)), hn::Sub(along_v, hn::ConvertTo(kFloat, j))},
                hn::Add(hn::Mul(row, splat_int(width_)), i),
                at.side};
    }

    HWY_INLINE std::array<IntLanes, 4> corners(const Cell& cell) const {
        const IntLanes upper = hn::Add(cell.first, splat_int(width_));
        return {cell.first, hn::Add(cell.first, splat_int(1)), upper, hn::Add(upper, splat_int(1))};
    }
    HWY_INLINE CornerRows corner_rows(const Cell& cell) const {
        return {cell.first, hn::Add(cell.first, splat_int(width_)), splat_mask(true)};
    }
    HWY_INLINE PointLanes surface_gradient(const PointLanes& e_r, const Cell& cell, FloatLanes distance,
                                           FloatLanes, FloatLanes slope_u, FloatLanes slope_v) const {
        const PointLanes s = to_side(cell.side, e_r);
        const FloatLanes m = hn::Abs(s.z);
        const FloatLanes m_squared = hn::Mul(m, m);
        const FloatLanes per_angle = splat(per_angle_);
        const FloatLanes a =
            hn::Div(hn::Mul(slope_u, per_angle), hn::Mul(distance, hn::Add(hn::Mul(s.x, s.x), m_squared)));
        const FloatLanes b =
            hn::Div(hn::Mul(slope_v, per_angle), hn::Mul(distance, hn::Add(hn::Mul(s.y, s.y), m_squared)));
        const FloatLanes along_m = hn::Add(hn::Mul(s.x, a), hn::Mul(s.y, b));
        const PointLanes gradient =
            from_side(cell.side, {hn::Sub(s.x, hn::Mul(a, m)), hn::Sub(s.y, hn::Mul(b, m)),
                                  hn::Add(s.z, choose(cell.side.negative, hn::Neg(along_m), along_m))});
        return choose(hn::Gt(distance, hn::Zero(kFloat)), gradient, e_r);
    }

  private:
    static HWY_INLINE Side side_of(const PointLanes& d) {
        const FloatLanes ax = hn::Abs(d.x);
        const FloatLanes ay = hn::Abs(d.y);
        const FloatLanes az = hn::Abs(d.z);
        const FloatMask is_z = hn::And(hn::Ge(az, ax), hn::Ge(az, ay));
        const FloatMask x_before_y = hn::Ge(ax, ay);
        const FloatMask is_x = hn::AndNot(is_z, x_before_y);
        const FloatMask is_y = none_of(hn::Or(is_z, x_before_y));
        const FloatLanes along = choose(is_x, d.x, choose(is_y, d.y, d.z));
        return {is_x, is_y, hn::Lt(along, hn::Zero(kFloat))};
    }
    static HWY_INLINE PointLanes to_side(const Side& side, const PointLanes& v) {
        return choose(side.is_x, turned_last(PoleAxis::X, v),
                      choose(side.is_y, turned_last(PoleAxis::Y, v), v));
    }
    static HWY_INLINE PointLanes from_side(const Side& side, const PointLanes& v) {
        return choose(side.is_x, turned_back(PoleAxis::X, v),
                      choose(side.is_y, turned_back(PoleAxis::Y, v), v));
    }
    HWY_INLINE FloatLanes along(FloatLanes p, FloatLanes m) const {
        const FloatLanes n = splat(n_float_);
        const FloatLanes cells = hn::Mul(hn::Add(hn::Mul(angle_of(p, m), splat(2 / kPi)), splat(0.5F)), n);
        return hn::Min(hn::Max(cells, hn::Zero(kFloat)), n);
    }

    std::int32_t n_, width_;
    float n_float_, per_angle_;
};

#endif

GridKernels cube() {
    return kernels_of<CubeLanes>();
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

HWY_EXPORT(cube);

GridKernels cube_kernels() noexcept {
    return ECHINUS_DISPATCH(cube)();
}

} // namespace echinus
#endif
