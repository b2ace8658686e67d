#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/ellipsoidal_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/spherical_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane

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

    Vec3f scale_; ///< in the grid's frame
};

#endif

GridKernels ellipsoidal() {
    return kernels_of<EllipsoidalLanes>();
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

HWY_EXPORT(ellipsoidal);

GridKernels ellipsoidal_kernels() noexcept {
    return ECHINUS_DISPATCH(ellipsoidal)();
}

} // namespace echinus
#endif
