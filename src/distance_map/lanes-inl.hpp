// What the kernels of this folder do to a vector of particles at once. Compiled once for each instruction
// set. Each step has the bits of its scalar counterpart: the same operations in the same order, no fused
// multiply-add.

#include "directions/angles.hpp"

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(ECHINUS_DISTANCE_MAP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#endif

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;
using Mask = hn::Mask<FloatTag>;
using IntMask = hn::Mask<IntTag>;

constexpr FloatTag kFloat;
constexpr IntTag kInt;
constexpr std::size_t kLanes = hn::MaxLanes(kFloat);

HWY_INLINE Floats splat(float value) {
    return hn::Set(kFloat, value);
}
HWY_INLINE Ints splat_int(std::int32_t value) {
    return hn::Set(kInt, value);
}
HWY_INLINE Mask as_mask(IntMask mask) {
    return hn::RebindMask(kFloat, mask);
}
HWY_INLINE IntMask as_int_mask(Mask mask) {
    return hn::RebindMask(kInt, mask);
}
HWY_INLINE Mask splat_mask(bool value) {
    return hn::Ne(splat(value ? 1.0F : 0.0F), hn::Zero(kFloat));
}
HWY_INLINE Ints choose(Mask mask, Ints yes, Ints no) {
    return hn::IfThenElse(as_int_mask(mask), yes, no);
}
HWY_INLINE Floats choose(Mask mask, Floats yes, Floats no) {
    return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE Mask none_of(Mask mask) {
    return hn::Not(mask);
}
HWY_INLINE Mask is_odd(Ints value) {
    return as_mask(hn::TestBit(value, splat_int(1)));
}

struct Vectors {
    Floats x, y, z;
};

HWY_INLINE Vectors choose(Mask mask, const Vectors& yes, const Vectors& no) {
    return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
}
HWY_INLINE Vectors scaled(const Vectors& v, Floats s) {
    return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)};
}
HWY_INLINE Vectors negated(const Vectors& v) {
    return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)};
}
HWY_INLINE Floats length(const Vectors& v) {
    return hn::Sqrt(hn::Add(hn::Add(hn::Mul(v.x, v.x), hn::Mul(v.y, v.y)), hn::Mul(v.z, v.z)));
}

/// atan2_polynomial() of directions/angles.hpp.
HWY_INLINE Floats angle_of(Floats y, Floats x) {
    const Floats ax = hn::Abs(x);
    const Floats ay = hn::Abs(y);
    const Mask flat = hn::Gt(ax, ay);
    const Floats larger = choose(flat, ax, ay);
    const Floats smaller = choose(flat, ay, ax);
    const Floats ratio = hn::IfThenElseZero(hn::Gt(larger, hn::Zero(kFloat)), hn::Div(smaller, larger));
    const Floats s = hn::Mul(ratio, ratio);
    Floats p = splat(kAtanCoefficients[0]);
    for (std::size_t i = 1; i < kAtanCoefficients.size(); ++i)
        p = hn::Add(hn::Mul(p, s), splat(kAtanCoefficients[i]));
    Floats angle = hn::Mul(p, ratio);
    angle = choose(hn::Gt(ay, ax), hn::Sub(splat(kPi / 2), angle), angle);
    angle = choose(hn::Lt(x, hn::Zero(kFloat)), hn::Sub(splat(kPi), angle), angle);
    return hn::CopySign(angle, y);
}

HWY_INLINE Ints floor_to_int(Floats value) {
    const Ints truncated = hn::ConvertTo(kInt, value);
    const Mask above = hn::Gt(hn::ConvertTo(kFloat, truncated), value);
    return hn::Add(truncated, hn::VecFromMask(kInt, as_int_mask(above))); // a mask is -1
}

// ---- Rows: four neighbouring numbers of an array for each lane. One load for all four and a transposition
// take the time of gathering one of them (0.65 against 0.7 ns a lane on the processor that was tried).

struct Rows {
    std::array<Floats, 4> at; ///< at[k]: the k-th number of each lane's row
};

/// The rows at positions[0], positions[4], positions[8] ... as the blocks of one vector.
template <typename Tag, typename LoadRow>
HWY_INLINE hn::Vec<Tag> every_fourth_row(Tag tag, const LoadRow& load_row, const std::int32_t* positions) {
    if constexpr (hn::MaxLanes(tag) == 4) {
        return load_row(positions[0]);
    } else {
        const hn::Half<Tag> half;
        constexpr std::size_t kHalf = hn::MaxLanes(half);
        return hn::Combine(tag, every_fourth_row(half, load_row, positions + kHalf),
                           every_fourth_row(half, load_row, positions));
    }
}

/// @param load_row  gives the four numbers from a position on as hn::Vec<hn::FixedTag<float, 4>>
template <typename LoadRow>
HWY_INLINE Rows load_rows(const LoadRow& load_row, Ints positions) {
    HWY_ALIGN std::int32_t position[kLanes];
    hn::Store(positions, kInt, position);
    const Floats a = every_fourth_row(kFloat, load_row, position);
    const Floats b = every_fourth_row(kFloat, load_row, position + 1);
    const Floats c = every_fourth_row(kFloat, load_row, position + 2);
    const Floats d = every_fourth_row(kFloat, load_row, position + 3);
    const hn::RepartitionToWide<FloatTag> pairs;
    const auto ab_low = hn::BitCast(pairs, hn::InterleaveLower(kFloat, a, b)); // a0 b0 a1 b1
    const auto cd_low = hn::BitCast(pairs, hn::InterleaveLower(kFloat, c, d));
    const auto ab_high = hn::BitCast(pairs, hn::InterleaveUpper(kFloat, a, b));
    const auto cd_high = hn::BitCast(pairs, hn::InterleaveUpper(kFloat, c, d));
    return {{hn::BitCast(kFloat, hn::InterleaveLower(pairs, ab_low, cd_low)),
             hn::BitCast(kFloat, hn::InterleaveUpper(pairs, ab_low, cd_low)),
             hn::BitCast(kFloat, hn::InterleaveLower(pairs, ab_high, cd_high)),
             hn::BitCast(kFloat, hn::InterleaveUpper(pairs, ab_high, cd_high))}};
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
