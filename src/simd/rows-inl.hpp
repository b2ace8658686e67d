// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_ROWS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_ROWS_INL
#undef ECHINUS_ROWS_INL
#else
#define ECHINUS_ROWS_INL
#endif

#include "simd/lanes-inl.hpp"

#include <cstddef>
#include <cstdint>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// The first three numbers of a row for each lane.
template <typename D>
struct Columns {
    hn::Vec<D> x, y, z;
};

/// A vector of rows of four: block b holds the row of lane 4 b + `first`.
template <typename D, typename RowOf>
HWY_INLINE hn::Vec<D> load_blocks(D d, const RowOf& row_of, std::size_t first) {
    if constexpr (hn::MaxLanes(D()) == 4) {
        return hn::LoadU(d, row_of(first) - 1);
    } else {
        constexpr hn::Half<D> half;
        return hn::Combine(d, load_blocks(half, row_of, first + hn::MaxLanes(half)),
                           load_blocks(half, row_of, first));
    }
}

/// Loads a row of three numbers for each lane and turns rows to columns. Where there are instructions that
/// gather, many processors take longer for one column by these than for all three by this.
/// @param row_of  of a lane: the first of its three numbers; one before it can be read, too
template <typename D, typename RowOf>
HWY_INLINE Columns<D> load_rows(D d, const RowOf& row_of) {
    constexpr hn::Repartition<std::uint64_t, D> pairs;
    const auto row_0 = load_blocks(d, row_of, 0), row_1 = load_blocks(d, row_of, 1);
    const auto row_2 = load_blocks(d, row_of, 2), row_3 = load_blocks(d, row_of, 3);
    const auto x_01 = hn::BitCast(pairs, hn::InterleaveLower(d, row_0, row_1));
    const auto x_23 = hn::BitCast(pairs, hn::InterleaveLower(d, row_2, row_3));
    const auto yz_01 = hn::BitCast(pairs, hn::InterleaveUpper(d, row_0, row_1));
    const auto yz_23 = hn::BitCast(pairs, hn::InterleaveUpper(d, row_2, row_3));
    return {hn::BitCast(d, hn::InterleaveUpper(pairs, x_01, x_23)),
            hn::BitCast(d, hn::InterleaveLower(pairs, yz_01, yz_23)),
            hn::BitCast(d, hn::InterleaveUpper(pairs, yz_01, yz_23))};
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
