#pragma once

#include "directions/lattice.hpp"
#include "geometry/whole_numbers.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace echinus {

/// |x| + |y| + |z|, the radial coordinate of octahedral maps. Within an octant, faces stay flat in it.
inline std::int64_t l1_norm(const LatticePoint& p) {
    return std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
}

/// The largest L1 norm of a point of a LatticeMesh: within its sphere it is at most sqrt(3) kLatticeExtent,
/// and snapping adds up to half a step on each axis.
inline constexpr std::int64_t kMostL1Norm = 908'095;
static_assert((2 * kMostL1Norm - 3) * (2 * kMostL1Norm - 3) >= 12 * kLatticeExtent * kLatticeExtent);

/// Directions on the octahedron |x| + |y| + |z| = 1. Each of its eight sides is cut into n^2 triangles by the
/// planes through the origin on which n |x| / (|x| + |y| + |z|) is an integer, and likewise for y and z.
///
/// Square (i, j) of side 1/n consists of the triangle *up*, below its diagonal, and, except in the last
/// square of each row, of the triangle *down*, above it. Cells are numbered by octant, then i, then j, then
/// up before down. A cell is cut into 16 *parts* in the same way, a quarter as wide and numbered in the same
/// order; for this, a *down* cell is first rotated by half a turn.
class OctahedralCells {
  public:
    static constexpr std::int32_t kPartsPerSide = 4;
    static constexpr std::int32_t kPartCount = kPartsPerSide * kPartsPerSide;

    explicit OctahedralCells(std::uint32_t divisions) : n_(static_cast<std::int32_t>(divisions)) {}

    std::int32_t divisions() const { return n_; }
    std::size_t count() const {
        return std::size_t{8} * static_cast<std::size_t>(n_) * static_cast<std::size_t>(n_);
    }

    /// Bits 0, 1 and 2 are set if x, y and z, respectively, are negative.
    static std::uint32_t octant_of(const LatticePoint& p) {
        return (p.x < 0 ? 1U : 0U) | (p.y < 0 ? 2U : 0U) | (p.z < 0 ? 4U : 0U);
    }

    /// The number of triangle (i, j, down) in a larger triangle cut into n^2.
    static constexpr std::uint32_t index_in_triangle(std::int32_t n, std::int32_t i, std::int32_t j,
                                                     bool down) {
        return static_cast<std::uint32_t>(i * (2 * n - i) + 2 * j + (down ? 1 : 0));
    }

    std::uint32_t index(std::uint32_t octant, std::int32_t i, std::int32_t j, bool down) const {
        return octant * static_cast<std::uint32_t>(n_ * n_) + index_in_triangle(n_, i, j, down);
    }

    /// The coordinates of a cell.
    struct Triangle {
        std::uint32_t octant;
        std::int32_t i, j;
        bool down;
    };

    Triangle triangle(std::uint32_t cell) const {
        const auto cells_per_octant = static_cast<std::uint32_t>(n_ * n_);
        const std::uint32_t in_octant = cell % cells_per_octant;
        // The rows before row i contain i (2n - i) cells, so in_octant < n^2 - (n - i)^2 for all rows after
        // it.
        const auto i =
            n_ - truncated_to<std::int32_t>(std::ceil(std::sqrt(double(cells_per_octant - in_octant))));
        const auto in_row = static_cast<std::int32_t>(in_octant) - i * (2 * n_ - i);
        return {cell / cells_per_octant, i, in_row / 2, in_row % 2 != 0};
    }

    /// The part that contains a cell's middle.
    static constexpr std::uint32_t middle_part() { return index_in_triangle(kPartsPerSide, 1, 1, false); }

    /// The direction of a cell's middle, which is on no wall. @pre the cell exists
    LatticePoint middle(std::uint32_t cell) const {
        const auto [octant, i, j, down] = triangle(cell);
        const std::int64_t third = down ? 2 : 1;
        const std::int64_t k = n_ - third - i - j;
        const std::int64_t scale = kLatticeExtent / (3 * n_);
        return mirrored(octant, LatticePoint{3 * i + third, 3 * j + third, 3 * k + third} * scale);
    }

    /// The corners of a cell on the octahedron.
    std::array<Vec3d, 3> corners(std::uint32_t cell) const {
        const auto [octant, i, j, down] = triangle(cell);
        const auto corner = [&, octant = octant](std::int32_t x, std::int32_t y) {
            return mirrored(octant, Vec3d{double(x), double(y), double(n_ - x - y)} * (1.0 / n_));
        };
        if (down) return {corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)};
        return {corner(i, j), corner(i + 1, j), corner(i, j + 1)};
    }

    struct Place {
        std::uint32_t cell, part;
    };

    /// The cell of a direction; for one on a wall, one of the cells that share it. As exact as integer
    /// arithmetic: a quotient of an integer below 2^30 and one below 2^21 differs from the next integer by at
    /// least 2^-21 or not at all, and the rounding errors below are far smaller than the 2^-30 that is added.
    /// @param p  components within kLatticeExtent; the origin counts as (e, e^2, e^3), as everywhere
    Place locate(const LatticePoint& p) const {
        constexpr double kNudge = 0x1p-30;
        const std::int32_t fine_n = kPartsPerSide * n_;
        const std::int64_t sum = l1_norm(p);
        const double parts_per_step = fine_n / static_cast<double>(sum);
        const double along_x =
            sum > 0 ? static_cast<double>(std::abs(p.x)) * parts_per_step + kNudge : fine_n;
        const double along_y = sum > 0 ? static_cast<double>(std::abs(p.y)) * parts_per_step + kNudge : 0;
        auto i = truncated_to<std::int32_t>(along_x);
        auto j = truncated_to<std::int32_t>(along_y);
        std::int32_t down = along_x + along_y - (i + j) > 1 + 4 * kNudge ? 1 : 0;
        if (i + j == fine_n) { // a corner of the grid on the octant's edge: step back into an adjacent cell
            if (i > 0)
                --i;
            else
                --j;
        }
        std::int32_t part_i = i % kPartsPerSide, part_j = j % kPartsPerSide;
        const bool cell_down = part_i + part_j + down >= kPartsPerSide;
        if (cell_down) {
            part_i = kPartsPerSide - 1 - part_i;
            part_j = kPartsPerSide - 1 - part_j;
            down = 1 - down;
        }
        return {index(octant_of(p), i / kPartsPerSide, j / kPartsPerSide, cell_down),
                index_in_triangle(kPartsPerSide, part_i, part_j, down != 0)};
    }

  private:
    template <typename T>
    static Vec3<T> mirrored(std::uint32_t octant, const Vec3<T>& v) {
        return {octant & 1U ? -v.x : v.x, octant & 2U ? -v.y : v.y, octant & 4U ? -v.z : v.z};
    }

    std::int32_t n_;
};

} // namespace echinus
