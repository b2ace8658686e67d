// Compiled once for each instruction set.

#include "geometry/angles.hpp"

#include <cstddef>

#if defined(ECHINUS_ANGLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_ANGLES_INL
#undef ECHINUS_ANGLES_INL
#else
#define ECHINUS_ANGLES_INL
#endif

#include "simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// atan2_polynomial() of geometry/angles.hpp: the same operations in the same order, hence the same bits.
HWY_INLINE FloatLanes angle_of(FloatLanes y, FloatLanes x) {
    const FloatLanes ax = hn::Abs(x);
    const FloatLanes ay = hn::Abs(y);
    const FloatMask flat = hn::Gt(ax, ay);
    const FloatLanes larger = choose(flat, ax, ay);
    const FloatLanes smaller = choose(flat, ay, ax);
    const FloatLanes ratio = hn::IfThenElseZero(hn::Gt(larger, hn::Zero(kFloat)), hn::Div(smaller, larger));
    const FloatLanes s = hn::Mul(ratio, ratio);
    FloatLanes p = splat(kAtanCoefficients[0]);
    for (std::size_t i = 1; i < kAtanCoefficients.size(); ++i)
        p = hn::Add(hn::Mul(p, s), splat(kAtanCoefficients[i]));
    FloatLanes angle = hn::Mul(p, ratio);
    angle = choose(hn::Gt(ay, ax), hn::Sub(splat(kPi / 2), angle), angle);
    angle = choose(hn::Lt(x, hn::Zero(kFloat)), hn::Sub(splat(kPi), angle), angle);
    return hn::CopySign(angle, y);
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#endif
