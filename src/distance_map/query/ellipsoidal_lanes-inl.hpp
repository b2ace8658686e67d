// EllipsoidalGrid for a vector of particles: the same members with the same bits.

#include "distance_map/query/spherical_lanes-inl.hpp"

#if defined(ECHINUS_DISTANCE_MAP_ELLIPSOIDAL_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_ELLIPSOIDAL_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_ELLIPSOIDAL_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_ELLIPSOIDAL_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

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

    Vec3f scale_; ///< in the grid's frame
};

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
