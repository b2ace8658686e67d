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
    std::array<std::uint32_t, 4> first_entry; ///< position of the sample's first entry
    std::array<float, 4> weight; ///< bilinear; 0 for ignored samples. Their sum is not 1 if some are.
    std::array<bool, 4> usable;
    float u, v;
    std::uint32_t entry_count; ///< of the reference sample, hence of all usable ones
    float weight_sum;
};

/// "the sample which is closer to (phi_d, theta_d) as the reference sample": distances along phi and theta in
/// cells.
inline int reference_corner(const SphericalGrid::Cell& cell) {
    return (cell.u > 0.5F ? 1 : 0) + (cell.v > 0.5F ? 2 : 0);
}

inline Interpolation interpolation_at(const DistanceMapView& map, const SphericalGrid::Cell& cell) {
    Interpolation result;
    result.u = cell.u;
    result.v = cell.v;
    const std::array<float, 4> bilinear{(1 - cell.u) * (1 - cell.v), cell.u * (1 - cell.v),
                                        (1 - cell.u) * cell.v, cell.u * cell.v};
    result.entry_count = entry_count_of(map, cell.corners[static_cast<std::size_t>(reference_corner(cell))]);
    result.weight_sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::uint32_t direction = cell.corners[corner];
        result.first_entry[corner] = map.entry_offsets[direction];
        // "ignore (in the interpolation) all the other samples with different length than the reference one"
        result.usable[corner] = entry_count_of(map, direction) == result.entry_count;
        result.weight[corner] = result.usable[corner] ? bilinear[corner] : 0;
        result.weight_sum += result.weight[corner];
    }
    return result;
}

/// The interpolated k-th distance. Ascends with k, since every usable sample does and rounding is monotone.
inline float interpolated_entry(const DistanceMapView& map, const Interpolation& at, std::uint32_t k) {
    float sum = 0;
    for (std::size_t corner = 0; corner < 4; ++corner)
        if (at.usable[corner]) sum += at.weight[corner] * entry_at(map, at.first_entry[corner] + k);
    return sum / at.weight_sum;
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
