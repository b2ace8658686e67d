// SphericalGrid for a vector of particles: the same members with the same bits.

#include "distance_map/query/lanes-inl.hpp"

#include <echinus/distance_map.hpp>

#if defined(ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_SPHERICAL_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

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
        IntLanes i, j; ///< its corner (0, 0); j is -1 or the last row beyond a pole
    };

    /// @param wanted  other lanes get some cell
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

    /// Everywhere but at the seam and the poles.
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

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
