#pragma once

#include "distance_map/layout.hpp"

#include <array>
#include <cmath>
#include <cstdint>

/// Interpolation of the entries of the samples around a direction (paper section 2.2): bilinear between the
/// four samples of a spherical grid, barycentric between the three of an octahedral one, of which one is then
/// listed twice, the second time with weight 0.
///
///     v
///     |   2 --- 3        Corners, numbered as in the grids' Cell. The sample nearest to the query is the
///     |   |   x |        *reference*; samples with a different number of entries are ignored.
///     |   0 --- 1
///     +---------- u
///
/// The interpolated quantity is the grid's *interpolant* of an entry: the distance, or the reciprocal of the
/// L1 norm.
namespace echinus {

/// The four samples around one direction, and the contribution of each.
template <typename Grid>
struct Interpolation {
    typename Grid::Cell cell;
    std::array<std::uint32_t, 4>
        first_entry; ///< where each sample's entries begin; for an ignored sample, those of the reference
    std::array<float, 4> weight; ///< 0 for ignored samples; the sum is 1
    std::array<bool, 4> usable;
    float weight_sum;          ///< the sum of the usable samples' weights before normalisation
    std::uint32_t entry_count; ///< entry count of the reference sample, hence of all usable ones
};

template <typename Grid>
Interpolation<Grid> interpolation_at(const DistanceMapView& map, const Grid&,
                                     const typename Grid::Cell& cell) {
    Interpolation<Grid> result;
    result.cell = cell;
    const std::array<float, 4> weights = Grid::weights(cell);
    const std::uint32_t reference = cell.corners[Grid::reference_corner(cell)];
    result.entry_count = entry_count_of(map, reference);
    result.weight_sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        // "ignore (in the interpolation) all the other samples with different length than the reference one"
        const bool same_count = entry_count_of(map, cell.corners[corner]) == result.entry_count;
        result.usable[corner] = same_count;
        result.first_entry[corner] = map.entry_offsets[same_count ? cell.corners[corner] : reference];
        result.weight[corner] = same_count ? weights[corner] : 0;
        result.weight_sum += result.weight[corner];
    }
    const auto& usable = result.usable;
    if (usable[0] && usable[1] && usable[2] && usable[3]) return result; // the weights already add up to 1
    for (float& weight : result.weight) weight /= result.weight_sum; // the reference's weight is at least 1/4
    return result;
}

template <typename Grid>
float interpolant_at(const DistanceMapView& map, const Interpolation<Grid>& at, std::size_t corner,
                     std::uint32_t k) {
    return Grid::interpolant(entry_at(map, at.first_entry[corner] + k), map.radius);
}

/// The interpolated k-th interpolant. Monotone in k, since each usable sample's interpolants are and rounding
/// is monotone.
template <typename Grid>
float interpolated(const DistanceMapView& map, const Interpolation<Grid>& at, std::uint32_t k) {
    float sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner)
        sum += at.weight[corner] * interpolant_at(map, at, corner, k);
    return sum;
}

struct Slope {
    float along_u, along_v; ///< derivatives of the interpolant per cell
};

/// The derivatives of interpolated() along u and v, without ignored samples (quotient rule).
/// @param value  interpolated(map, at, k)
template <typename Grid>
Slope slope_of_entry(const DistanceMapView& map, const Interpolation<Grid>& at, std::uint32_t k,
                     float value) {
    const auto weight = Grid::weight_derivatives(at.cell);
    Slope slope{0, 0};
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (!at.usable[corner]) continue;
        const float excess = interpolant_at(map, at, corner, k) - value;
        slope.along_u += weight.along_u[corner] * excess;
        slope.along_v += weight.along_v[corner] * excess;
    }
    return {slope.along_u / at.weight_sum, slope.along_v / at.weight_sum};
}

} // namespace echinus
