// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_COMPRESS_INL
#undef ECHINUS_COMPRESS_INL
#else
#define ECHINUS_COMPRESS_INL
#endif

#include "simd/compress_table.hpp"
#include "simd/lanes-inl.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// The chosen lanes of up to two vectors, moved together.
class Compressor {
  public:
    explicit Compressor(IntMask chosen) : chosen_(chosen) {
#if HWY_TARGET != HWY_AVX3
        std::uint8_t bits[8];
        hn::StoreMaskBits(Ints(), chosen, bits);
        constexpr hn::Rebind<std::uint8_t, Ints> bytes;
        places_ = hn::IndicesFromVec(Ints(),
                                     hn::PromoteTo(Ints(), hn::LoadU(bytes, kCompressTable[bits[0]].data())));
        count_ = static_cast<std::size_t>(std::popcount(bits[0]));
#endif
    }

    std::size_t count() const {
#if HWY_TARGET == HWY_AVX3
        return hn::CountTrue(Ints(), chosen_);
#else
        return count_;
#endif
    }

    /// The lanes that were not chosen follow, or zeros.
    IntLanes operator()(IntLanes lanes) const {
#if HWY_TARGET == HWY_AVX3 // the only one with an instruction for it
        return hn::Compress(lanes, chosen_);
#else
        return hn::TableLookupLanes(lanes, places_);
#endif
    }

  private:
    IntMask chosen_;
#if HWY_TARGET != HWY_AVX3
    decltype(hn::IndicesFromVec(Ints(), IntLanes())) places_;
    std::size_t count_;
#endif
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
