// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_WASM_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_WASM_LANES_INL
#undef ECHINUS_WASM_LANES_INL
#else
#define ECHINUS_WASM_LANES_INL
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#if HWY_TARGET == HWY_WASM && !HWY_HAVE_FLOAT64 // only for the version that lacks these operations

#include <wasm_simd128.h>

/// Operations of our kernels that WebAssembly supports but Highway's target for it (1.0) lacks: vectors of
/// two doubles, and lane lookups by an instruction, which Highway implements byte by byte through memory.
/// They have Highway's names and are in its namespace, where its templates find them.
/// @pre vectors and masks are full, 16 bytes, except in conversions between float and double
HWY_BEFORE_NAMESPACE();
namespace hwy::HWY_NAMESPACE {

using WholeDoubles = Simd<double, 2, 0>;
using WholeDoubleVec = Vec128<double, 2>;
using WholeDoubleMask = Mask128<double, 2>;

HWY_API WholeDoubleVec Set(WholeDoubles /*tag*/, double value) {
    return {wasm_f64x2_splat(value)};
}

HWY_API WholeDoubleVec operator+(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_add(a.raw, b.raw)};
}
HWY_API WholeDoubleVec operator-(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_sub(a.raw, b.raw)};
}
HWY_API WholeDoubleVec operator*(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_mul(a.raw, b.raw)};
}
HWY_API WholeDoubleVec operator/(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_div(a.raw, b.raw)};
}
HWY_API WholeDoubleVec Sqrt(WholeDoubleVec v) {
    return {wasm_f64x2_sqrt(v.raw)};
}
HWY_API WholeDoubleVec Abs(WholeDoubleVec v) {
    return {wasm_f64x2_abs(v.raw)};
}
/// Rounds to the nearest integer, halves to the even one.
HWY_API WholeDoubleVec Round(WholeDoubleVec v) {
    return {wasm_f64x2_nearest(v.raw)};
}

HWY_API WholeDoubleMask operator<(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_lt(a.raw, b.raw)};
}
HWY_API WholeDoubleMask operator<=(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_le(a.raw, b.raw)};
}
HWY_API WholeDoubleMask operator>(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_gt(a.raw, b.raw)};
}
HWY_API WholeDoubleMask operator==(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_eq(a.raw, b.raw)};
}
HWY_API WholeDoubleMask operator!=(WholeDoubleVec a, WholeDoubleVec b) {
    return {wasm_f64x2_ne(a.raw, b.raw)};
}

HWY_API WholeDoubleVec PromoteTo(WholeDoubles /*tag*/, Vec128<float, 2> v) {
    return {wasm_f64x2_promote_low_f32x4(v.raw)};
}
HWY_API Vec128<float, 2> DemoteTo(Simd<float, 2, 0> /*tag*/, WholeDoubleVec v) {
    return {wasm_f32x4_demote_f64x2_zero(v.raw)};
}

HWY_API Indices128<std::int32_t, 4> IndicesFromVec(Simd<std::int32_t, 4, 0> /*tag*/,
                                                   Vec128<std::int32_t, 4> lanes) {
    // Lane k begins at byte 4 k.
    const auto first_bytes = wasm_i32x4_mul(lanes.raw, wasm_i32x4_splat(0x0404'0404));
    return {wasm_i32x4_add(first_bytes, wasm_i32x4_splat(0x0302'0100))};
}
HWY_API Indices128<float, 4> IndicesFromVec(Simd<float, 4, 0> /*tag*/, Vec128<std::int32_t, 4> lanes) {
    return {IndicesFromVec(Simd<std::int32_t, 4, 0>(), lanes).raw};
}
HWY_API Vec128<std::int32_t, 4> TableLookupLanes(Vec128<std::int32_t, 4> v,
                                                 Indices128<std::int32_t, 4> from) {
    return {wasm_i8x16_swizzle(v.raw, from.raw)};
}
HWY_API Vec128<float, 4> TableLookupLanes(Vec128<float, 4> v, Indices128<float, 4> from) {
    return {wasm_i8x16_swizzle(v.raw, from.raw)};
}

} // namespace hwy::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

#endif
