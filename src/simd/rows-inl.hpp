// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_ROWS_INL
#undef ECHINUS_ROWS_INL
#else
#define ECHINUS_ROWS_INL
#endif

#include "simd/lanes-inl.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Four numbers for each lane: at[k] holds the k-th of each.
template <typename D>
struct Columns {
    std::array<hn::Vec<D>, 4> at;
};

/// The rows of every fourth lane, from the first on, as the blocks of one vector.
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

/// Loads a row of four numbers for each lane and turns rows to columns. Where there are instructions that
/// gather, many processors take as long for one column by these as this takes for all four, or longer.
/// @param load_row  of a lane: its row, as hn::Vec<hn::FixedTag<hn::TFromD<D>, 4>>
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

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
