// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_LANES_INL
#undef ECHINUS_LANES_INL
#else
#define ECHINUS_LANES_INL
#endif

#include "simd/vec3_lanes-inl.hpp"

#include <echinus/geometry.hpp>

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Vectors of the instruction set's full width.
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
/// @pre no index is above 2^31
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

#if HWY_TARGET != HWY_SCALAR // HWY_SCALAR uses the reference instead

/// Four numbers per lane: at[k] holds the k-th number of each.
template <typename D>
struct Columns {
    std::array<hn::Vec<D>, 4> at;
};

/// The rows of every fourth lane, starting with lane `first`, as the blocks of one vector.
template <typename D, typename LoadRow>
HWY_INLINE hn::Vec<D> load_blocks(D d, const LoadRow& load_row, std::size_t first) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return load_row(first);
    } else {
        constexpr hn::Half<D> half;
        return hn::Combine(d, load_blocks(half, load_row, first + hn::MaxLanes(half)),
                           load_blocks(half, load_row, first));
    }
}

/// Loads a row of four numbers for each lane and transposes rows to columns. Even on processors with gather
/// instructions, gathering one column often takes at least as long as this does for all four.
/// @param load_row  returns the row of a lane, as hn::Vec<hn::FixedTag<hn::TFromD<D>, 4>>
template <typename D, typename LoadRow>
HWY_INLINE Columns<D> load_rows(D d, const LoadRow& load_row) {
    constexpr hn::Repartition<std::uint64_t, D> pairs;
    const auto row_0 = load_blocks(d, load_row, 0), row_1 = load_blocks(d, load_row, 1);
    const auto row_2 = load_blocks(d, load_row, 2), row_3 = load_blocks(d, load_row, 3);
    const auto low_01 = hn::BitCast(pairs, hn::InterleaveLower(d, row_0, row_1));
    const auto low_23 = hn::BitCast(pairs, hn::InterleaveLower(d, row_2, row_3));
    const auto high_01 = hn::BitCast(pairs, hn::InterleaveUpper(d, row_0, row_1));
    const auto high_23 = hn::BitCast(pairs, hn::InterleaveUpper(d, row_2, row_3));
    return {{hn::BitCast(d, hn::InterleaveLower(pairs, low_01, low_23)),
             hn::BitCast(d, hn::InterleaveUpper(pairs, low_01, low_23)),
             hn::BitCast(d, hn::InterleaveLower(pairs, high_01, high_23)),
             hn::BitCast(d, hn::InterleaveUpper(pairs, high_01, high_23))}};
}

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
