// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_CROSSING_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_CROSSING_LANES_INL
#undef ECHINUS_CROSSING_LANES_INL
#else
#define ECHINUS_CROSSING_LANES_INL
#endif

#include "simd/lanes-inl.hpp"

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// How faces count for particles, one pair per lane.
template <typename D>
struct CrossingLanes {
    hn::Vec<hn::RebindToSigned<D>> crossing; ///< as crossing_on() has it, where sure
    hn::Mask<D> unsure;
};

/// A filter in single precision for crossing_on().
///
/// With corners a, b, c counted from the particle p, the ray from the origin through p passes an edge (a, b)
/// on the side given by the sign of p . (a x b), and p lies on the side of the plane given by the sign of a .
/// (b x c); added to the sum of the former, that is the volume as seen from the origin.
///
/// Corners are exact here: differences of whole numbers up to 2^19. With m^2 the largest of |a|^2, |b|^2,
/// |c|^2 and u = 2^-24, each component of a x b is off by at most 4 u m^2, and its product with a vector v by
/// at most 10 u |v| m^2 in the L1 norm, which is at most 3 * 2^19 for p and 3 * 2^20 for a: less than m^2 and
/// 2 m^2. So three edges and the volume: less than 5 m^2, and a little for their sum. Three times as much is
/// allowed for.
/// @param f       of the lanes
/// @param before  with its sign bit set, crossings between the origin and p are wanted; else those from p on
template <typename D, typename Lanes>
HWY_INLINE CrossingLanes<D> crossings_of(D f, const Vec3Lanes<Lanes>& a, const Vec3Lanes<Lanes>& b,
                                         const Vec3Lanes<Lanes>& c, const Vec3Lanes<Lanes>& p,
                                         hn::Vec<hn::RebindToSigned<D>> before) {
    constexpr hn::RebindToSigned<D> i;
    const Vec3Lanes<Lanes> b_c = fused_cross(b, c);
    const Lanes past_bc = fused_dot(p, b_c);
    const Lanes past_ca = fused_dot(p, fused_cross(c, a));
    const Lanes past_ab = fused_dot(p, fused_cross(a, b));
    const Lanes volume = fused_dot(a, b_c);
    const Lanes bound =
        hn::Mul(hn::Max(hn::Max(fused_dot(a, a), fused_dot(b, b)), fused_dot(c, c)), hn::Set(f, 16));

    // All of one sign, and by how much; negative where the signs differ.
    const Lanes least = hn::Min(hn::Min(past_ab, past_bc), past_ca);
    const Lanes most = hn::Max(hn::Max(past_ab, past_bc), past_ca);
    const Lanes hit = hn::Max(least, hn::Neg(most));
    // Where it is hit, from its front with sign +: the plane lies ahead of p where the first is positive,
    // behind the origin where the second is negative.
    const Lanes sign_bit = hn::SignBit(f);
    const Lanes side = hn::And(past_ab, sign_bit);
    const Lanes ahead = hn::Xor(volume, side);
    const Lanes from_origin = hn::Add(ahead, hn::Abs(hn::Add(hn::Add(past_ab, past_bc), past_ca)));
    const Lanes wanted = hn::Xor(ahead, hn::And(hn::BitCast(f, before), sign_bit));
    const Lanes clear_of_plane = hn::Min(hn::Abs(volume), from_origin);
    const hn::Mask<D> counts = hn::Gt(hn::Min(hit, wanted), bound);
    const hn::Mask<D> unsure = hn::Le(hn::Min(hn::Abs(hit), hn::Max(hn::Neg(hit), clear_of_plane)), bound);
    const auto sign = hn::Or(hn::BroadcastSignBit(hn::BitCast(i, past_ab)), hn::Set(i, 1));
    return {hn::IfThenElseZero(hn::RebindMask(i, counts), sign), unsure};
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
