#pragma once

#include "directions/lattice.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/directions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

namespace echinus {

/// Directions on the octahedron |x| + |y| + |z| = 1, unfolded into a square like an octahedral map of unit
/// vectors (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014,
/// section 3): the half z >= 0 is the diamond in its middle, and the sides below are folded out into its
/// corners.
///
///     +-------+-------+    Columns count along U from 0 to 2n, rows along V; (n, n) is +z, the four corners
///     |  -z / | \ -z  |    are -z. A side's edge is cut into n, which makes squares of side 1; each is cut
///     |   /   |   \   |    into two triangles by the diagonal that is parallel to the line drawn in its
///     | /  +z | +z  \ |    quarter. Each side is thus cut into n^2 equal triangles, within which everything
///     +-------+-------+    is affine. Samples on the border of the square appear twice, that of the corners
///     | \  +z | +z  / |    four times.
///     |   \   |   /   |
///     |  -z \ | / -z  |
///     +-------+-------+
///
/// The radial coordinate is the L1 norm |x| + |y| + |z|. Its reciprocal is affine over a plane and is
/// therefore the interpolated quantity (as depth buffers use 1/z).
class OctahedralGrid {
  public:
    explicit OctahedralGrid(std::uint32_t divisions)
        : n_(static_cast<std::int32_t>(divisions)), width_(2 * divisions + 1) {}

    std::uint32_t divisions() const { return static_cast<std::uint32_t>(n_); }
    std::uint32_t width() const { return width_; }
    std::size_t direction_count() const { return std::size_t{width_} * width_; }
    std::uint32_t index(std::uint32_t column, std::uint32_t row) const { return row * width_ + column; }

    /// The index of the sample that represents all samples with the same direction.
    std::uint32_t canonical(std::uint32_t column, std::uint32_t row) const {
        const std::uint32_t last = width_ - 1;
        if (column == 0 || column == last) row = std::min(row, last - row);
        if (row == 0 || row == last) column = std::min(column, last - column);
        return index(column, row);
    }

    /// A sample in integers: n times its point on the octahedron, without rounding.
    LatticePoint sample(std::uint32_t column, std::uint32_t row) const {
        const std::int64_t x = static_cast<std::int64_t>(column) - n_,
                           y = static_cast<std::int64_t>(row) - n_;
        const std::int64_t z = n_ - std::abs(x) - std::abs(y);
        if (z >= 0) return {x, y, z};
        return {x > 0 ? n_ - std::abs(y) : std::abs(y) - n_, y > 0 ? n_ - std::abs(x) : std::abs(x) - n_, z};
    }

    /// Vectors with L1 norm 1 to all samples by index.
    std::vector<Vec3d> directions() const {
        return for_all_samples<Vec3d>([this](const LatticePoint& p) { return Vec3d(p) * (1.0 / n_); });
    }
    /// The same directions exactly, scaled up as far as the lattice allows.
    std::vector<LatticePoint> lattice_directions() const {
        return for_all_samples<LatticePoint>(
            [this](const LatticePoint& p) { return p * (kLatticeExtent / n_); });
    }
    /// The solid angle of each sample, up to a common factor.
    std::vector<double> solid_angle_weights() const {
        return for_all_samples<double>([](const LatticePoint& p) {
            const double l = length(Vec3d(p));
            return 1 / (l * l * l);
        });
    }

    static double radial_norm(const Vec3d& d) { return std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z); }
    /// The largest radial coordinate in a sphere: sqrt(3) times the radius, rounded up.
    static float largest_entry(float radius) { return radius * 1.7320509F; }

    struct Coordinates {
        float along_u, along_v; ///< in [0, 2n]
        float stretch;          ///< Euclidean length divided by L1 length along this ray
    };

    /// @param d  of any length; 0 counts as +z. Must be finite, otherwise the coordinates are meaningless
    Coordinates coordinates_of(const Vec3f& d) const {
        const auto n = static_cast<float>(n_);
        const float ax = std::fabs(d.x), ay = std::fabs(d.y);
        const float l1 = ax + ay + std::fabs(d.z);
        const float scale = l1 > 0 ? n / l1 : 0;
        const float x = std::min(ax * scale, n), y = std::min(ay * scale, n);
        const bool below = d.z < 0;
        const float u = below ? n - y : x, v = below ? n - x : y;
        return {n + std::copysign(u, d.x), n + std::copysign(v, d.y), l1 > 0 ? length(d) / l1 : 1};
    }

    struct Cell {
        /// Direction indices of the square's corners (0,0), (1,0), (0,1), (1,1), the first coordinate along
        /// U. The one outside the triangle is replaced by one of the triangle's corners.
        std::array<std::uint32_t, 4> corners;
        float u, v;    ///< in [0, 1], within the square
        bool mirrored; ///< the diagonal runs from (0,0) to (1,1), and not from (1,0) to (0,1)
        float rest; ///< weight of the corner on the near side of the diagonal; negative beyond the diagonal
        std::int32_t i, j;

        bool beyond() const { return rest < 0; }
        /// The corner of the square that is not one of the triangle's.
        std::size_t doubled() const { return (beyond() ? 0U : 3U) ^ (mirrored ? 1U : 0U); }
    };

    Cell cell_at(const Coordinates& at) const {
        Cell cell;
        cell.i = std::min(truncated_to<std::int32_t>(at.along_u), 2 * n_ - 1);
        cell.j = std::min(truncated_to<std::int32_t>(at.along_v), 2 * n_ - 1);
        cell.u = at.along_u - static_cast<float>(cell.i);
        cell.v = at.along_v - static_cast<float>(cell.j);
        cell.mirrored = (cell.i >= n_) != (cell.j >= n_);
        cell.rest = (cell.mirrored ? cell.u : 1 - cell.u) - cell.v;
        const auto first = index(static_cast<std::uint32_t>(cell.i), static_cast<std::uint32_t>(cell.j));
        cell.corners = {first, first + 1, first + width_, first + width_ + 1};
        cell.corners[cell.doubled()] = cell.corners[cell.mirrored ? 0U : 1U];
        return cell;
    }
    Cell locate(const Vec3f& d) const { return cell_at(coordinates_of(d)); }

    /// The barycentric weights in the triangle; 0 for the corner outside it.
    static std::array<float, 4> weights(const Cell& cell) {
        const float u = cell.mirrored ? 1 - cell.u : cell.u;
        const bool beyond = cell.beyond();
        const std::array<float, 4> w{beyond ? 0 : cell.rest, beyond ? 1 - cell.v : u, beyond ? 1 - u : cell.v,
                                     beyond ? -cell.rest : 0};
        return cell.mirrored ? std::array<float, 4>{w[1], w[0], w[3], w[2]} : w;
    }

    /// The sample nearest to the query: the one with the largest weight.
    static std::size_t reference_corner(const Cell& cell) {
        const std::array<float, 4> w = weights(cell);
        std::size_t best = 0;
        for (std::size_t corner = 1; corner < 4; ++corner)
            if (w[corner] > w[best]) best = corner;
        return best;
    }
    /// The samples that interpolation uses: all except the corner outside the triangle.
    static bool is_sample(const Cell& cell, std::size_t corner) { return corner != cell.doubled(); }

    struct Derivatives {
        std::array<float, 4> along_u, along_v;
    };
    static Derivatives weight_derivatives(const Cell& cell) {
        const float near = cell.beyond() ? 0.0F : 1.0F, far = 1 - near;
        const std::array<float, 4> u{-near, near, -far, far}, v{-near, -far, near, far};
        if (!cell.mirrored) return {u, v};
        return {{-u[1], -u[0], -u[3], -u[2]}, {v[1], v[0], v[3], v[2]}};
    }

    // Between samples 1/t is affine. Entries below 2^-20 R, half a lattice step, count as 2^-20 R.
    static float interpolant(float entry, float radius) { return 1 / std::max(entry, radius * 0x1p-20F); }
    static float interpolant_at(const Vec3d& d) { return static_cast<float>(1 / radial_norm(d)); }
    /// The Euclidean distance along a ray.
    static float distance_of(float interpolated, const Coordinates& at) { return at.stretch / interpolated; }
    static bool is_farther(float interpolant, float other) { return interpolant < other; }
    /// An entry whose interpolant was moved by `shift`.
    static float moved(float entry, float shift, bool outward) {
        if (!outward) return 1 / (1 / entry + shift);
        const float rest = 1 / entry - shift;
        return rest > 0 ? 1 / rest : std::numeric_limits<float>::infinity();
    }

    /// The gradient of the plane m.x = 1 that a triangle's interpolants span, times the distance.
    /// @param value  the interpolated reciprocal; slope_u and slope_v are its derivatives
    Vec3f surface_gradient(const Vec3f&, const Cell& cell, float distance, float value, float slope_u,
                           float slope_v) const {
        const auto n = static_cast<float>(n_);
        const float x = static_cast<float>(cell.i - n_) + cell.u,
                    y = static_cast<float>(cell.j - n_) + cell.v;
        const float sign_x = cell.i >= n_ ? 1.0F : -1.0F, sign_y = cell.j >= n_ ? 1.0F : -1.0F;
        const std::int32_t across =
            (cell.i >= n_ ? cell.i - n_ : n_ - 1 - cell.i) + (cell.j >= n_ ? cell.j - n_ : n_ - 1 - cell.j);
        const bool towards_middle = is_towards_middle(cell);
        const bool below = across + (towards_middle ? 0 : 1) >= n_;
        // f(p) = |p|_1 W(u(p)) is linear in each octant, and 1 on the surface.
        const float at_middle = value - slope_u * x - slope_v * y;
        const Vec3f m{sign_x * at_middle + n * slope_u, sign_y * at_middle + n * slope_v,
                      below ? -(at_middle + n * (sign_x * slope_u + sign_y * slope_v)) : at_middle};
        return m * distance;
    }

    static Vec3f to_grid(const Vec3f& v) { return v; }
    static Vec3f from_grid(const Vec3f& v) { return v; }
    static Vec3d to_grid(const Vec3d& v) { return v; }

    /// Calls `visit(corners)` for each small triangle, with the indices of its corners counter-clockwise seen
    /// from outside, since unfolding preserves orientation. Samples that appear several times have one index,
    /// so that the square's border is closed.
    template <typename Visit>
    void for_each_facet(const Visit& visit) const {
        const auto n = static_cast<std::uint32_t>(n_);
        for (std::uint32_t j = 0; j < 2 * n; ++j)
            for (std::uint32_t i = 0; i < 2 * n; ++i) {
                const std::array<std::uint32_t, 4> q{canonical(i, j), canonical(i + 1, j),
                                                     canonical(i + 1, j + 1), canonical(i, j + 1)};
                const std::size_t turn = (i >= n) != (j >= n) ? 1 : 0; // depends on the diagonal
                visit(std::array{q[turn], q[turn + 1], q[(turn + 3) % 4]});
                visit(std::array{q[turn + 1], q[(turn + 2) % 4], q[(turn + 3) % 4]});
            }
    }

  private:
    /// Does a cell lie on the side of its square's diagonal towards the middle of the unfolded square?
    bool is_towards_middle(const Cell& cell) const {
        // The corner on the near side of the diagonal is (0, 0) or, if mirrored, (1, 0); it points towards
        // the middle in squares above the middle row.
        return (cell.j >= n_) != cell.beyond();
    }

    template <typename T, typename Make>
    std::vector<T> for_all_samples(const Make& make) const {
        std::vector<T> result;
        result.reserve(direction_count());
        for (std::uint32_t row = 0; row < width_; ++row)
            for (std::uint32_t column = 0; column < width_; ++column)
                result.push_back(make(sample(column, row)));
        return result;
    }

    std::int32_t n_;
    std::uint32_t width_;
};

} // namespace echinus
