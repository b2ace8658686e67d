#pragma once

#include "directions/spherical_grid.hpp"
#include "distance_map/layout.hpp"

#include <array>
#include <cmath>
#include <cstdint>

/// Bilinear interpolation of the entries of the four samples around a direction (paper section 2.2).
///
///     v
///     |   2 --- 3        Corners, numbered as in SphericalGrid::Cell. The sample nearest to the query is the
///     |   |   x |        *reference*; samples with another number of entries than it has are ignored.
///     |   0 --- 1
///     +---------- u
namespace echinus {

/// The four samples around one direction and what each contributes.
struct Interpolation {
    std::array<std::uint32_t, 4>
        first_entry;             ///< where each sample's entries begin; the reference's if ignored
    std::array<float, 4> weight; ///< bilinear, 0 for ignored samples; they add up to 1
    std::array<bool, 4> usable;
    float u, v;
    float weight_sum;          ///< what the weights of the usable samples added up to before
    std::uint32_t entry_count; ///< of the reference sample, hence of all usable ones
};

/// "the sample which is closer to (phi_d, theta_d) as the reference sample": distances along phi and theta in
/// cells.
inline std::size_t reference_corner(const SphericalGrid::Cell& cell) {
    return (cell.u > 0.5F ? 1U : 0U) + (cell.v > 0.5F ? 2U : 0U);
}

inline Interpolation interpolation_at(const DistanceMapView& map, const SphericalGrid::Cell& cell) {
    Interpolation result;
    result.u = cell.u;
    result.v = cell.v;
    const std::array<float, 4> bilinear{(1 - cell.u) * (1 - cell.v), cell.u * (1 - cell.v),
                                        (1 - cell.u) * cell.v, cell.u * cell.v};
    const std::uint32_t reference = cell.corners[reference_corner(cell)];
    result.entry_count = entry_count_of(map, reference);
    result.weight_sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        // "ignore (in the interpolation) all the other samples with different length than the reference one"
        const bool same_count = entry_count_of(map, cell.corners[corner]) == result.entry_count;
        result.usable[corner] = same_count;
        result.first_entry[corner] = map.entry_offsets[same_count ? cell.corners[corner] : reference];
        result.weight[corner] = same_count ? bilinear[corner] : 0;
        result.weight_sum += result.weight[corner];
    }
    const auto& usable = result.usable;
    if (usable[0] && usable[1] && usable[2] && usable[3]) return result; // they add up to 1 already
    for (float& weight : result.weight) weight /= result.weight_sum; // the reference's alone is 1/4 or more
    return result;
}

/// The interpolated k-th distance. Ascends with k, since every usable sample does and rounding is monotone.
inline float interpolated_entry(const DistanceMapView& map, const Interpolation& at, std::uint32_t k) {
    float sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner)
        sum += at.weight[corner] * entry_at(map, at.first_entry[corner] + k);
    return sum;
}

struct Slope {
    float along_u, along_v; ///< distance per cell
};

/// The derivatives of interpolated_entry() along u and v, ignored samples ignored (quotient rule).
inline Slope slope_of_entry(const DistanceMapView& map, const Interpolation& at, std::uint32_t k) {
    const std::array<float, 4> weight_u{at.v - 1, 1 - at.v, -at.v, at.v};
    const std::array<float, 4> weight_v{at.u - 1, -at.u, 1 - at.u, at.u};
    const float value = interpolated_entry(map, at, k);
    Slope slope{0, 0};
    for (std::size_t corner = 0; corner < 4; ++corner) {
        if (!at.usable[corner]) continue;
        const float excess = entry_at(map, at.first_entry[corner] + k) - value;
        slope.along_u += weight_u[corner] * excess;
        slope.along_v += weight_v[corner] * excess;
    }
    return {slope.along_u / at.weight_sum, slope.along_v / at.weight_sum};
}

} // namespace echinus
