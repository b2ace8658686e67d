// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_LANES_INL
#undef ECHINUS_LANES_INL
#else
#define ECHINUS_LANES_INL
#endif

#include "simd/wasm_lanes-inl.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Vectors as wide as the instruction set has them.
using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using FloatLanes = hn::Vec<Floats>;
using IntLanes = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;
using IntMask = hn::Mask<Ints>;

/// Points or directions of several particles. Never without values: for Arm, GCC compiles what sets up an
/// empty one for a processor without vectors, and then refuses.
struct PointLanes {
    FloatLanes x, y, z;
};

inline PointLanes at_origin() {
    return {hn::Zero(Floats()), hn::Zero(Floats()), hn::Zero(Floats())};
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
