// The entries of a map in either format, and its offsets, for vectors of particles: loaded as rows of four
// neighbours, or gathered.

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
namespace { // private to this folder

using FourFloats = hn::FixedTag<float, 4>;

/// The entries of a map in its format, which is tested at run time: that branch is always predicted, whereas
/// separate kernels for the two formats would double the code.
class EntryLanes {
  public:
    explicit EntryLanes(const DistanceMapView& map)
        : wide_(map.entries_float32.data()), narrow_(map.entries_unorm16.data()),
          is_wide_(map.entry_format == EntryFormat::Float32),
          step_(is_wide_ ? 1 : map.largest_entry() / kUnormSteps) {}

    /// The entries at each lane's position and the three after it, for entry_of().
    HWY_INLINE Rows load_rows(IntLanes positions) const {
        return is_wide_ ? load_rows_at(WideRows{wide_}, positions)
                        : load_rows_at(NarrowRows{narrow_}, positions);
    }
    /// The distances that a loaded column holds, in the mesh's unit.
    HWY_INLINE FloatLanes entry_of(FloatLanes loaded) const {
        return is_wide_ ? loaded : hn::Mul(hn::ConvertTo(kFloat, hn::BitCast(kInt, loaded)), splat(step_));
    }
    /// The distance at each lane's position, in the mesh's unit.
    HWY_INLINE FloatLanes gather(IntLanes positions) const {
        return is_wide_ ? hn::GatherIndex(kFloat, wide_, positions) : gather_narrow(positions);
    }

  private:
    struct WideRows {
        const float* entries;

        HWY_INLINE hn::Vec<FourFloats> operator()(std::int32_t position) const {
            return hn::LoadU(FourFloats(), entries + position);
        }
    };
    struct NarrowRows {
        const std::uint16_t* entries;

        HWY_INLINE hn::Vec<FourFloats> operator()(std::int32_t position) const {
            const auto narrow = hn::LoadU(hn::FixedTag<std::uint16_t, 4>(), entries + position);
            return hn::BitCast(FourFloats(), hn::PromoteTo(hn::FixedTag<std::uint32_t, 4>(), narrow));
        }
    };

    /// Gathers each entry together with the one before it, so that nothing beyond the last entry is read.
    HWY_INLINE FloatLanes gather_narrow(IntLanes positions) const {
        const IntLanes before = hn::Max(hn::Sub(positions, splat_int(1)), hn::Zero(kInt));
        const auto* pairs = reinterpret_cast<const std::int32_t*>(narrow_);
        const IntLanes pair = hn::GatherOffset(kInt, pairs, hn::Add(before, before));
        const FloatMask is_first = as_mask(hn::Eq(positions, hn::Zero(kInt)));
        const IntLanes first = hn::And(pair, splat_int(0xFFFF));
        const IntLanes second = hn::And(hn::ShiftRight<16>(pair), splat_int(0xFFFF));
        return entry_of(hn::BitCast(kFloat, choose(is_first, first, second)));
    }

    const float* wide_;
    const std::uint16_t* narrow_;
    bool is_wide_;
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
