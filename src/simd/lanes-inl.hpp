// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_LANES_INL
#undef ECHINUS_LANES_INL
#else
#define ECHINUS_LANES_INL
#endif

#include "simd/wasm_lanes-inl.hpp"

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

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

constexpr Floats kFloat;
constexpr Ints kInt;
constexpr std::size_t kLanes = hn::MaxLanes(kFloat);

HWY_INLINE FloatLanes splat(float value) {
    return hn::Set(kFloat, value);
}
HWY_INLINE IntLanes splat_int(std::int32_t value) {
    return hn::Set(kInt, value);
}
HWY_INLINE FloatMask as_mask(IntMask mask) {
    return hn::RebindMask(kFloat, mask);
}
HWY_INLINE IntMask as_int_mask(FloatMask mask) {
    return hn::RebindMask(kInt, mask);
}
HWY_INLINE FloatMask splat_mask(bool value) {
    return hn::Ne(splat(value ? 1.0F : 0.0F), hn::Zero(kFloat));
}
HWY_INLINE IntLanes choose(FloatMask mask, IntLanes yes, IntLanes no) {
    return hn::IfThenElse(as_int_mask(mask), yes, no);
}
HWY_INLINE FloatLanes choose(FloatMask mask, FloatLanes yes, FloatLanes no) {
    return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE FloatMask none_of(FloatMask mask) {
    return hn::Not(mask);
}
HWY_INLINE FloatMask is_odd(IntLanes value) {
    return as_mask(hn::TestBit(value, splat_int(1)));
}

HWY_INLINE PointLanes choose(FloatMask mask, const PointLanes& yes, const PointLanes& no) {
    return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE PointLanes scaled(const PointLanes& v, FloatLanes s) {
    return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)};
}
HWY_INLINE PointLanes negated(const PointLanes& v) {
    return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}
HWY_INLINE FloatLanes length(const PointLanes& v) {
    return hn::Sqrt(hn::Add(hn::Add(hn::Mul(v.x, v.x), hn::Mul(v.y, v.y)), hn::Mul(v.z, v.z)));
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
