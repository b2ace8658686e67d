#pragma once

#include "directions/clipped_face.hpp"
#include "directions/cube_grid.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace echinus {

/// Calls `visit(index)` for a superset of the samples of one side of the cube that lie inside a face's cone
/// or at most `reach` cells outside it. Each at most once. Which samples meet the face is decided exactly
/// afterwards, so the C library's functions suffice here.
template <typename Visit>
void for_each_sample_of_side_near(const CubeGrid& grid, std::uint32_t side,
                                  const std::array<LatticePoint, 3>& face, double reach, const Visit& visit) {
    constexpr double kMargin = 1e-5; // radians; far above the rounding of these lines and of the lattice
    const double cells_per_radian = 2 * grid.divisions() / std::numbers::pi;
    std::array<Vec3d, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = CubeGrid::to_side(side, Vec3d(face[c]));
        if (CubeGrid::is_negative(side)) corners[c].z = -corners[c].z;
    }
    // The part that the side sees, and a little more.
    ClippedFace part(corners);
    const double half_opening = std::numbers::pi / 4 + reach / cells_per_radian + kMargin;
    const double across = std::cos(half_opening), along = std::sin(half_opening);
    part.cut({across, 0, along});
    part.cut({-across, 0, along});
    part.cut({0, across, along});
    part.cut({0, -across, along});
    if (part.empty()) return;

    double u_min = std::numbers::pi, u_max = -u_min, v_min = u_min, v_max = -u_min;
    if (part.is_all_around()) std::swap(u_min, u_max), std::swap(v_min, v_max);
    for (const Vec3d& p : part) {
        const double u = std::atan2(p.x, p.z), v = std::atan2(p.y, p.z);
        u_min = std::min(u_min, u), u_max = std::max(u_max, u);
        v_min = std::min(v_min, v), v_max = std::max(v_max, v);
    }
    const auto n = static_cast<double>(grid.divisions());
    const auto first = [&](double angle) {
        const double place = std::ceil((angle - kMargin) * cells_per_radian + n / 2 - reach);
        return truncated_to<std::int64_t>(std::clamp(place, 0.0, n + 1));
    };
    const auto last = [&](double angle) {
        const double place = std::floor((angle + kMargin) * cells_per_radian + n / 2 + reach);
        return truncated_to<std::int64_t>(std::clamp(place, -1.0, n));
    };
    for (std::int64_t j = first(v_min); j <= last(v_max); ++j)
        for (std::int64_t i = first(u_min); i <= last(u_max); ++i)
            visit(grid.index(side, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)));
}

/// The same for all sides.
template <typename Visit>
void for_each_sample_near(const CubeGrid& grid, const std::array<LatticePoint, 3>& face, double reach,
                          const Visit& visit) {
    for (std::uint32_t side = 0; side < 6; ++side)
        for_each_sample_of_side_near(grid, side, face, reach, visit);
}

} // namespace echinus
