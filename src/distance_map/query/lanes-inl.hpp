// What the kernels of this folder do to a vector of particles at once. Compiled once for each instruction
// set. Each step has the bits of its scalar counterpart: the same operations in the same order, no fused
// multiply-add.

#include "directions/bilinear_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(ECHINUS_DISTANCE_MAP_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#undef ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#else
#define ECHINUS_DISTANCE_MAP_LANES_INL_HPP
#endif

#include "directions/angles-inl.hpp"
#include "simd/rows-inl.hpp"

#if HWY_TARGET != HWY_SCALAR // whose vectors have one lane
HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

/// turned_last() and turned_back() of directions/bilinear_grid.hpp.
HWY_INLINE PointLanes turned_last(PoleAxis axis, const PointLanes& v) {
    switch (axis) {
    case PoleAxis::X:
        return {v.y, v.z, v.x};
    case PoleAxis::Y:
        return {v.z, v.x, v.y};
    default:
        return v;
    }
}
HWY_INLINE PointLanes turned_back(PoleAxis axis, const PointLanes& v) {
    if (axis == PoleAxis::Z) return v;
    return turned_last(axis == PoleAxis::X ? PoleAxis::Y : PoleAxis::X, v);
}

HWY_INLINE IntLanes floor_to_int(FloatLanes value) {
    const IntLanes truncated = hn::ConvertTo(kInt, value);
    const FloatMask above = hn::Gt(hn::ConvertTo(kFloat, truncated), value);
    return hn::Add(truncated, hn::VecFromMask(kInt, as_int_mask(above))); // a mask is -1
}

using Rows = Columns<Floats>;

/// The same for each corner of a cell.
template <typename OfCorner>
HWY_INLINE auto at_corners(const OfCorner& of_corner) {
    return std::array<decltype(of_corner(0)), 4>{of_corner(0), of_corner(1), of_corner(2), of_corner(3)};
}

/// Four neighbouring numbers of an array for each lane.
/// @param load_row  gives the four numbers from a position on as hn::Vec<hn::FixedTag<float, 4>>
template <typename LoadRow>
HWY_INLINE Rows load_rows_at(const LoadRow& load_row, IntLanes positions) {
    HWY_ALIGN std::int32_t position[kLanes];
    hn::Store(positions, kInt, position);
    return load_rows(kFloat, [&](std::size_t lane) HWY_ATTR { return load_row(position[lane]); });
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();
#endif

#endif
