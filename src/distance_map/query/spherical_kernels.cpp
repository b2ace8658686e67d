#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/spherical_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/spherical_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

GridKernels spherical() {
    return kernels_of<SphericalLanes>();
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

HWY_EXPORT(spherical);

GridKernels spherical_kernels() noexcept {
    return ECHINUS_DISPATCH(spherical)();
}

} // namespace echinus
#endif
