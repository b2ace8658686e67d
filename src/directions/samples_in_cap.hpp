#pragma once

#include "directions/direction_cap.hpp"
#include "directions/ellipsoidal_grid.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace echinus {

/// Calls `visit(index)` for the samples of a grid inside a cap, and those at most `reach` cells outside it
/// along phi and theta.
template <typename Visit>
void for_each_sample_in(const SphericalGrid& grid, const DirectionCap& cap, double reach,
                        const Visit& visit) {
    const auto count_of_rows = static_cast<std::int64_t>(grid.colatitude_count());
    const auto count_of_columns = static_cast<std::int64_t>(grid.longitude_count());
    const double rows_per_radian = static_cast<double>(count_of_rows) / std::numbers::pi;
    const double columns_per_radian = static_cast<double>(count_of_columns) / (2 * std::numbers::pi);
    const auto at_or_above = [reach](double s) { return truncated_to<std::int64_t>(std::ceil(s - reach)); };
    const auto at_or_below = [reach](double s) { return truncated_to<std::int64_t>(std::floor(s + reach)); };

    const std::int64_t first_row =
        std::max<std::int64_t>(at_or_above(cap.theta_min * rows_per_radian - 0.5), 0);
    const std::int64_t last_row =
        std::min(at_or_below(cap.theta_max * rows_per_radian - 0.5), count_of_rows - 1);
    std::int64_t first_column = at_or_above((cap.phi_middle - cap.phi_half_width) * columns_per_radian);
    std::int64_t last_column = at_or_below((cap.phi_middle + cap.phi_half_width) * columns_per_radian);
    if (last_column - first_column + 1 >= count_of_columns) {
        first_column = 0;
        last_column = count_of_columns - 1;
    }
    for (std::int64_t row = first_row; row <= last_row; ++row)
        for (std::int64_t column = first_column; column <= last_column; ++column) {
            const std::int64_t wrapped = column < 0                   ? column + count_of_columns
                                         : column >= count_of_columns ? column - count_of_columns
                                                                      : column;
            visit(grid.index(static_cast<std::uint32_t>(wrapped), static_cast<std::uint32_t>(row)));
        }
}

/// Calls `visit(index)` for a superset of the samples that lie inside a face's cone or at most `reach` cells
/// outside it.
template <typename Visit>
void for_each_sample_near(const SphericalGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    const DirectionCap cap(
        {Vec3d(grid.to_grid(face[0])), Vec3d(grid.to_grid(face[1])), Vec3d(grid.to_grid(face[2]))});
    for_each_sample_in(grid, cap, reach, visit);
}

/// The same in the scaled frame, in which the samples are those of a sphere: the face is scaled too. Angles
/// there may be larger than in the mesh's frame, by at most the inverse of the smallest scale, hence the
/// margin.
template <typename Visit>
void for_each_sample_near(const EllipsoidalGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    const Vec3d scale(grid.scale_in_grid());
    std::array<Vec3d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = product(Vec3d(grid.to_grid(face[c])), scale);
    const DirectionCap cap(corners, DirectionCap::kMargin / static_cast<double>(grid.smallest_scale()));
    for_each_sample_in(grid, cap, reach, visit);
}

} // namespace echinus
