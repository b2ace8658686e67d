// The spherical grid and the ellipsoidal one, which is a spherical grid in a stretched frame.

#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/spherical_kernels.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane

/// SphericalGrid for a vector of particles: the same members with the same bits.
class SphericalLanes : public BilinearLanes {
  public:
    explicit SphericalLanes(const DistanceMapView& map)
        : pole_axis_(map.pole_axis), columns_(static_cast<std::int32_t>(map.longitude_count)),
          rows_(static_cast<std::int32_t>(map.colatitude_count)),
          per_phi_(static_cast<float>(map.longitude_count) / (2 * kPi)),
          per_theta_(static_cast<float>(map.colatitude_count) / kPi) {}

    HWY_INLINE PointLanes to_grid(const PointLanes& v) const { return turned_last(pole_axis_, v); }
    HWY_INLINE PointLanes from_grid(const PointLanes& v) const { return turned_back(pole_axis_, v); }

    struct Coordinates {
        FloatLanes along_phi, along_theta;
    };

    HWY_INLINE Coordinates coordinates_of(const PointLanes& d_grid) const {
        const FloatLanes horizontal =
            hn::Sqrt(hn::Add(hn::Mul(d_grid.x, d_grid.x), hn::Mul(d_grid.y, d_grid.y)));
        const FloatLanes phi = angle_of(d_grid.y, d_grid.x);
        const FloatLanes theta = angle_of(horizontal, d_grid.z);
        return {hn::Mul(phi, splat(per_phi_)), hn::Sub(hn::Mul(theta, splat(per_theta_)), splat(0.5F))};
    }

    struct Cell : Place {
        IntLanes i, j; ///< its corner (0, 0); beyond a pole, j is -1 or the last row
    };

    /// @param wanted  other lanes get an arbitrary valid cell
    HWY_INLINE Cell cell_at(const Coordinates& at, FloatMask wanted) const {
        const FloatLanes along_phi = hn::IfThenElseZero(wanted, at.along_phi);
        const FloatLanes along_theta = hn::IfThenElseZero(wanted, at.along_theta);
        const IntLanes phi_floor = floor_to_int(along_phi);
        const IntLanes j = floor_to_int(along_theta);
        const FloatMask negative = as_mask(hn::Lt(phi_floor, hn::Zero(kInt)));
        return {{hn::Sub(along_phi, hn::ConvertTo(kFloat, phi_floor)),
                 hn::Sub(along_theta, hn::ConvertTo(kFloat, j))},
                choose(negative, hn::Add(phi_floor, splat_int(columns_)), phi_floor),
                j};
    }

    HWY_INLINE std::array<IntLanes, 4> corners(const Cell& cell) const {
        const IntLanes next = hn::Add(cell.i, splat_int(1));
        const IntLanes next_i = choose(as_mask(hn::Eq(next, splat_int(columns_))), hn::Zero(kInt), next);
        const IntLanes next_j = hn::Add(cell.j, splat_int(1));
        return {corner(cell.i, cell.j), corner(next_i, cell.j), corner(cell.i, next_j),
                corner(next_i, next_j)};
    }

    /// The rows of corners; they exist except at the seam and the poles.
    HWY_INLINE CornerRows corner_rows(const Cell& cell) const {
        const IntLanes lower = hn::Add(hn::Mul(cell.j, splat_int(columns_)), cell.i);
        const IntMask beyond_pole =
            hn::Or(hn::Lt(cell.j, hn::Zero(kInt)), hn::Gt(cell.j, splat_int(rows_ - 2)));
        const IntMask on_seam = hn::Gt(cell.i, splat_int(columns_ - 2));
        return {lower, hn::Add(lower, splat_int(columns_)), none_of(as_mask(hn::Or(beyond_pole, on_seam)))};
    }

    HWY_INLINE PointLanes surface_gradient(const PointLanes& e_r, const Cell&, FloatLanes distance,
                                           FloatLanes, FloatLanes slope_u, FloatLanes slope_v) const {
        const FloatLanes zero = hn::Zero(kFloat);
        const FloatLanes sine = hn::Sqrt(hn::Add(hn::Mul(e_r.x, e_r.x), hn::Mul(e_r.y, e_r.y)));
        const FloatMask has_angles = hn::And(hn::Gt(sine, zero), hn::Gt(distance, zero));
        const PointLanes e_phi{hn::Div(hn::Neg(e_r.y), sine), hn::Div(e_r.x, sine), zero};
        const PointLanes e_theta = cross(e_phi, e_r);
        const FloatLanes along_theta = hn::Div(hn::Mul(slope_v, splat(per_theta_)), distance);
        const FloatLanes along_phi = hn::Div(hn::Mul(slope_u, splat(per_phi_)), hn::Mul(distance, sine));
        return choose(has_angles, e_r - e_theta * along_theta - e_phi * along_phi, e_r);
    }

  private:
    HWY_INLINE IntLanes corner(IntLanes i, IntLanes j) const {
        const std::int32_t half = columns_ / 2;
        const FloatMask below = as_mask(hn::Lt(j, hn::Zero(kInt)));
        const FloatMask beyond = as_mask(hn::Gt(j, splat_int(rows_ - 1)));
        const FloatMask near_half = as_mask(hn::Lt(i, splat_int(half)));
        IntLanes opposite = choose(near_half, hn::Add(i, splat_int(half)), hn::Sub(i, splat_int(half)));
        opposite = hn::IfThenElseZero(hn::Lt(opposite, splat_int(columns_)), opposite);
        const IntLanes column = choose(hn::Or(below, beyond), opposite, i);
        const IntLanes row = choose(below, hn::Zero(kInt), choose(beyond, splat_int(rows_ - 1), j));
        return hn::Add(hn::Mul(row, splat_int(columns_)), column);
    }

    PoleAxis pole_axis_;
    std::int32_t columns_, rows_;
    float per_phi_, per_theta_;
};

/// EllipsoidalGrid for a vector of particles: the same members with the same bits.
class EllipsoidalLanes : public SphericalLanes {
  public:
    explicit EllipsoidalLanes(const DistanceMapView& map)
        : SphericalLanes(map), scale_(turned_last(map.pole_axis, map.scale)) {}

    struct Coordinates : SphericalLanes::Coordinates {
        FloatLanes stretch;
    };

    HWY_INLINE Coordinates coordinates_of(const PointLanes& d_grid) const {
        const PointLanes g = in_scaled_frame(d_grid);
        const FloatLanes radial = length(g);
        return {SphericalLanes::coordinates_of(g),
                choose(hn::Gt(radial, hn::Zero(kFloat)), hn::Div(length(d_grid), radial), splat(1))};
    }

    static HWY_INLINE FloatLanes distance_of(FloatLanes interpolated, const Coordinates& at) {
        return hn::Mul(interpolated, at.stretch);
    }

    HWY_INLINE PointLanes surface_gradient(const PointLanes& e_r, const Cell& cell, FloatLanes,
                                           FloatLanes value, FloatLanes slope_u, FloatLanes slope_v) const {
        const PointLanes g = in_scaled_frame(e_r);
        const PointLanes unit = g * hn::Div(splat(1), length(g));
        return in_scaled_frame(SphericalLanes::surface_gradient(unit, cell, value, value, slope_u, slope_v));
    }

  private:
    HWY_INLINE PointLanes in_scaled_frame(const PointLanes& v) const { return times(v, splat(scale_)); }

    Vec3f scale_; ///< the scale in the grid's frame
};

#endif

GridKernels spherical() {
    return kernels_of<SphericalLanes>();
}

GridKernels ellipsoidal() {
    return kernels_of<EllipsoidalLanes>();
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

HWY_EXPORT(spherical);
HWY_EXPORT(ellipsoidal);

GridKernels spherical_kernels() noexcept {
    return ECHINUS_DISPATCH(spherical)();
}

GridKernels ellipsoidal_kernels() noexcept {
    return ECHINUS_DISPATCH(ellipsoidal)();
}

} // namespace echinus
#endif
