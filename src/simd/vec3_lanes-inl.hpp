// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_VEC3_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_VEC3_LANES_INL
#undef ECHINUS_VEC3_LANES_INL
#else
#define ECHINUS_VEC3_LANES_INL
#endif

#include "simd/wasm_lanes-inl.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Vec3 of several particles or faces at once: a Highway vector for each component. The operations are those
/// of Vec3 (geometry.hpp) in the same order, hence with the same bits.
///
/// Must always be initialised with values: for Arm, GCC compiles the initialisation of an empty object for a
/// processor without vectors, which is an error.
template <typename Lanes>
struct Vec3Lanes {
    Lanes x, y, z;
};

template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> operator+(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> operator-(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> operator-(const Vec3Lanes<Lanes>& a) {
    return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> operator*(const Vec3Lanes<Lanes>& a, Lanes s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
/// The componentwise product.
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> times(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
template <typename Lanes>
HWY_INLINE Lanes dot(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> cross(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
template <typename Lanes>
HWY_INLINE Lanes length(const Vec3Lanes<Lanes>& a) {
    return hn::Sqrt(dot(a, a));
}
template <typename Lanes>
HWY_INLINE Lanes l1_norm(const Vec3Lanes<Lanes>& a) {
    return hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(a.z));
}
template <typename Mask, typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> choose(Mask mask, const Vec3Lanes<Lanes>& yes, const Vec3Lanes<Lanes>& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
            hn::IfThenElse(mask, yes.z, no.z)};
}

// Uses fused multiply-add if there are instructions for it, which is faster but gives different bits on
// different machines. Only for bounds that allow for the rounding of either form.

template <typename Lanes>
HWY_INLINE Lanes fused_dot(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return hn::MulAdd(a.z, b.z, hn::MulAdd(a.y, b.y, hn::Mul(a.x, b.x)));
}
template <typename Lanes>
HWY_INLINE Vec3Lanes<Lanes> fused_cross(const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
