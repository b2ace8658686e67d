#include "distance_map/query/grid_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "distance_map/query/octahedral_kernels.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "distance_map/query/batch_lanes-inl.hpp"
#include "distance_map/query/octahedral_lanes-inl.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

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
