// The entries of a map, in their two formats, and its offsets, for vectors of particles: loaded as rows of
// four neighbours, or gathered.

#include <echinus/distance_map.hpp>

#if defined(ECHINUS_DISTANCE_MAP_ENTRY_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_ENTRY_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_ENTRY_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_ENTRY_LANES_INL_HPP
#endif

#include "distance_map/query/lanes-inl.hpp"

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {
namespace { // its names are this folder's

using FourFloats = hn::FixedTag<float, 4>;

class FloatEntries {
  public:
    explicit FloatEntries(const DistanceMapView& map) : entries_(map.entries_float32.data()) {}

    HWY_INLINE hn::Vec<FourFloats> operator()(std::int32_t position) const {
        return hn::LoadU(FourFloats(), entries_ + position);
    }
    /// What a row holds, in the mesh's unit.
    HWY_INLINE FloatLanes entry_of(FloatLanes loaded) const { return loaded; }
    HWY_INLINE FloatLanes gather(IntLanes positions) const {
        return hn::GatherIndex(kFloat, entries_, positions);
    }

  private:
    const float* entries_;
};

class UnormEntries {
  public:
    explicit UnormEntries(const DistanceMapView& map)
        : entries_(map.entries_unorm16.data()), step_(map.largest_entry() / kUnormSteps) {}

    HWY_INLINE hn::Vec<FourFloats> operator()(std::int32_t position) const {
        const auto narrow = hn::LoadU(hn::FixedTag<std::uint16_t, 4>(), entries_ + position);
        return hn::BitCast(FourFloats(), hn::PromoteTo(hn::FixedTag<std::uint32_t, 4>(), narrow));
    }
    HWY_INLINE FloatLanes entry_of(FloatLanes loaded) const {
        return hn::Mul(hn::ConvertTo(kFloat, hn::BitCast(kInt, loaded)), splat(step_));
    }
    /// Gathers pairs, each with the entry before, so that nothing beyond the last is read.
    HWY_INLINE FloatLanes gather(IntLanes positions) const {
        const IntLanes before = hn::Max(hn::Sub(positions, splat_int(1)), hn::Zero(kInt));
        const auto* pairs = reinterpret_cast<const std::int32_t*>(entries_);
        const IntLanes pair = hn::GatherOffset(kInt, pairs, hn::Add(before, before));
        const FloatMask is_first = as_mask(hn::Eq(positions, hn::Zero(kInt)));
        const IntLanes first = hn::And(pair, splat_int(0xFFFF));
        const IntLanes second = hn::And(hn::ShiftRight<16>(pair), splat_int(0xFFFF));
        return entry_of(hn::BitCast(kFloat, choose(is_first, first, second)));
    }

  private:
    const std::uint16_t* entries_;
    float step_;
};

struct OffsetRows {
    const std::uint32_t* offsets;

    HWY_INLINE hn::Vec<FourFloats> operator()(std::int32_t position) const {
        const hn::FixedTag<std::uint32_t, 4> four;
        return hn::BitCast(FourFloats(), hn::LoadU(four, offsets + position));
    }
};

} // namespace
} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
