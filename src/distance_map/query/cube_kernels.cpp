#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/cube_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/cube_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

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
