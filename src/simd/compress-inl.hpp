// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_COMPRESS_INL
#undef ECHINUS_COMPRESS_INL
#else
#define ECHINUS_COMPRESS_INL
#endif

#include "simd/lanes-inl.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#ifndef ECHINUS_COMPRESS_TABLE // shared by all instruction sets
#define ECHINUS_COMPRESS_TABLE
namespace echinus {

/// For each choice of up to eight lanes, one bit each: the chosen lanes in order, then the others.
inline constexpr auto kCompressTable = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (std::size_t bits = 0; bits < table.size(); ++bits) {
        std::size_t count = 0;
        for (const std::size_t chosen : {1, 0})
            for (std::uint8_t lane = 0; lane < 8; ++lane)
                if ((bits >> lane & 1) == chosen) table[bits][count++] = lane;
    }
    return table;
}();

} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_SCALAR // these have an instruction for it, or only one lane

/// Moves the chosen lanes of vectors to the beginning; the lanes after them are arbitrary. Highway 1.0 would
/// copy its table to the stack for each call.
class Compressor {
  public:
    explicit Compressor(IntMask chosen) : chosen_(chosen) {}

    std::size_t count() const { return hn::CountTrue(Ints(), chosen_); }
    IntLanes operator()(IntLanes lanes) const { return hn::Compress(lanes, chosen_); }
    FloatLanes operator()(FloatLanes lanes) const {
        return hn::Compress(lanes, hn::RebindMask(Floats(), chosen_));
    }

  private:
    IntMask chosen_;
};

#else

class Compressor {
  public:
    explicit Compressor(IntMask chosen) {
        constexpr hn::Rebind<std::uint8_t, Ints> bytes;
        std::uint8_t bits[8];
        hn::StoreMaskBits(Ints(), chosen, bits);
        count_ = static_cast<std::size_t>(std::popcount(bits[0]));
        places_ = hn::PromoteTo(Ints(), hn::LoadU(bytes, kCompressTable[bits[0]].data()));
    }

    std::size_t count() const { return count_; }
    IntLanes operator()(IntLanes lanes) const {
        return hn::TableLookupLanes(lanes, hn::IndicesFromVec(Ints(), places_));
    }
    FloatLanes operator()(FloatLanes lanes) const {
        return hn::TableLookupLanes(lanes, hn::IndicesFromVec(Floats(), places_));
    }

  private:
    IntLanes places_;
    std::size_t count_;
};

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
