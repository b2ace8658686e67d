// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_LANES_INL
#undef ECHINUS_LANES_INL
#else
#define ECHINUS_LANES_INL
#endif

#include "simd/vec3_lanes-inl.hpp"

#include <echinus/geometry.hpp>

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Vectors as wide as the instruction set has them.
using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using FloatLanes = hn::Vec<Floats>;
using IntLanes = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;
using IntMask = hn::Mask<Ints>;

/// Points or directions of several particles.
using PointLanes = Vec3Lanes<FloatLanes>;

inline PointLanes at_origin() {
    return {hn::Zero(Floats()), hn::Zero(Floats()), hn::Zero(Floats())};
}

constexpr Floats kFloat;
constexpr Ints kInt;
constexpr std::size_t kLanes = hn::MaxLanes(kFloat);

HWY_INLINE FloatLanes splat(float value) {
    return hn::Set(kFloat, value);
}
HWY_INLINE PointLanes splat(const Vec3f& v) {
    return {splat(v.x), splat(v.y), splat(v.z)};
}
HWY_INLINE IntLanes splat_int(std::int32_t value) {
    return hn::Set(kInt, value);
}
/// @pre none is above 2^31
HWY_INLINE IntLanes load_indices(const std::uint32_t* from) {
    return hn::BitCast(kInt, hn::LoadU(hn::RebindToUnsigned<Ints>(), from));
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

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
