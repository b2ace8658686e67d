#pragma once

#include "directions/bilinear_grid.hpp"
#include "directions/lattice.hpp"
#include "geometry/elementary.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/directions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace echinus {

/// Directions on the six sides of a cube, with even angles between them along each side (the equiangular or
/// tangent-warped cube map: Ronchi et al., "The Cubed Sphere", J. Comput. Phys. 124, 1996; for this warp
/// among others: Zucker and Higashi, "Cube-to-sphere Projections for Procedural Texturing and Beyond", JCGT
/// 2018).
///
/// A side represents a direction as (p, q, m): m along its outward axis, the largest of the three in
/// magnitude, p and q along the two axes that follow it cyclically. Sample (i, j) of a side is at p / m =
/// tan(pi / 4 (2 i / n - 1)), with q / m given by j in the same way, for i and j from 0 to n. Sides are
/// numbered +x, -x, +y, -y, +z, -z. Each has its own samples on its border, so that samples on the cube's
/// edges appear twice and those on its corners three times, and no cell extends across an edge.
///
/// The interpolated quantity is the distance, as on the paper's grid.
class CubeGrid : public BilinearGrid {
  public:
    explicit CubeGrid(std::uint32_t divisions)
        : n_(static_cast<std::int32_t>(divisions)), width_(divisions + 1) {}

    std::uint32_t divisions() const { return static_cast<std::uint32_t>(n_); }
    std::size_t direction_count() const { return 6 * std::size_t{width_} * width_; }
    std::uint32_t index(std::uint32_t side, std::uint32_t column, std::uint32_t row) const {
        return (side * width_ + row) * width_ + column;
    }

    /// A vector as (p, q, m); m keeps the sign that it has in the mesh's frame.
    template <typename T>
    static Vec3<T> to_side(std::uint32_t side, const Vec3<T>& v) {
        return turned_last(PoleAxis(side / 2), v);
    }
    template <typename T>
    static Vec3<T> from_side(std::uint32_t side, const Vec3<T>& v) {
        return turned_back(PoleAxis(side / 2), v);
    }
    static bool is_negative(std::uint32_t side) { return side % 2 == 1; }

    /// Unit vectors of all samples by index. Samples with the same direction have the same bits.
    std::vector<Vec3d> directions() const {
        std::vector<Vec3d> result;
        for_all_samples([&](std::uint32_t side, double p, double q) {
            const Vec3d v = from_side(side, Vec3d{p, q, is_negative(side) ? -1.0 : 1.0});
            result.push_back(v * (1 / length(v)));
        });
        return result;
    }
    std::vector<LatticePoint> lattice_directions() const { return echinus::lattice_directions(directions()); }
    /// The solid angle of each sample, up to a common factor; on a side's border it is halved, on the side's
    /// corners quartered.
    std::vector<double> solid_angle_weights() const {
        std::vector<double> result;
        for_all_samples([&](std::uint32_t, double p, double q) {
            const double square = 1 + p * p + q * q;
            const double border = (p * p == 1 ? 0.5 : 1) * (q * q == 1 ? 0.5 : 1);
            result.push_back(border * (1 + p * p) * (1 + q * q) / (square * std::sqrt(square)));
        });
        return result;
    }

    struct Coordinates {
        float along_u, along_v; ///< in [0, n]
        std::uint32_t side;
    };

    /// @param d  of any length; 0 counts as +z. Must be finite, otherwise the coordinates are meaningless
    Coordinates coordinates_of(const Vec3f& d) const {
        const std::uint32_t side = side_of(d);
        const Vec3f s = to_side(side, d);
        const float m = std::fabs(s.z);
        return {along(s.x, m), along(s.y, m), side};
    }

    struct Cell : BilinearGrid::Cell {
        std::uint32_t side;
    };

    Cell cell_at(const Coordinates& at) const {
        const std::int32_t i = std::clamp(truncated_to<std::int32_t>(at.along_u), 0, n_ - 1);
        const std::int32_t j = std::clamp(truncated_to<std::int32_t>(at.along_v), 0, n_ - 1);
        const std::uint32_t first =
            index(at.side, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j));
        return {{{first, first + 1, first + width_, first + width_ + 1},
                 at.along_u - static_cast<float>(i),
                 at.along_v - static_cast<float>(j)},
                at.side};
    }
    Cell locate(const Vec3f& d) const { return cell_at(coordinates_of(d)); }

    /// The gradient of |x| - S(u, v) on the map's surface; u grows with the angle atan(p / m), whose gradient
    /// is (m, 0, -p) / (p^2 + m^2).
    /// @param distance  S; slope_u and slope_v are its derivatives per cell
    Vec3f surface_gradient(const Vec3f& e_r, const Cell& cell, float distance, float, float slope_u,
                           float slope_v) const {
        if (!(distance > 0)) return e_r;
        const Vec3f s = to_side(cell.side, e_r);
        const float m = std::fabs(s.z);
        const float per_angle = 2 * static_cast<float>(n_) / kPi;
        const float a = slope_u * per_angle / (distance * (s.x * s.x + m * m));
        const float b = slope_v * per_angle / (distance * (s.y * s.y + m * m));
        const float along_m = s.x * a + s.y * b;
        return from_side(
            cell.side, Vec3f{s.x - a * m, s.y - b * m, s.z + (is_negative(cell.side) ? -along_m : along_m)});
    }

    static Vec3f to_grid(const Vec3f& v) { return v; }
    static Vec3f from_grid(const Vec3f& v) { return v; }
    static Vec3d to_grid(const Vec3d& v) { return v; }

    /// Calls `visit(corners)` for each cell, with the indices of its corners counter-clockwise seen from
    /// outside. A sample that appears several times is represented by its first occurrence, so that no gaps
    /// remain at the cube's edges.
    template <typename Visit>
    void for_each_facet(const Visit& visit) const {
        for (std::uint32_t side = 0; side < 6; ++side)
            for (std::uint32_t j = 0; j + 1 < width_; ++j)
                for (std::uint32_t i = 0; i + 1 < width_; ++i) {
                    const std::array<std::uint32_t, 4> q{canonical(side, i, j), canonical(side, i + 1, j),
                                                         canonical(side, i + 1, j + 1),
                                                         canonical(side, i, j + 1)};
                    if (is_negative(side)) // p and q run clockwise on this side
                        visit(std::array{q[0], q[3], q[2], q[1]});
                    else
                        visit(q);
                }
    }

    /// The lowest of the indices of all samples with the same direction.
    std::uint32_t canonical(std::uint32_t side, std::uint32_t column, std::uint32_t row) const {
        const std::int64_t n = n_;
        const Vec3<std::int64_t> v =
            from_side(side, Vec3<std::int64_t>{2 * std::int64_t{column} - n, 2 * std::int64_t{row} - n,
                                               is_negative(side) ? -n : n});
        for (std::uint32_t other = 0; other < side; ++other) {
            const Vec3<std::int64_t> s = to_side(other, v);
            if (s.z == (is_negative(other) ? -n : n))
                return index(other, static_cast<std::uint32_t>((s.x + n) / 2),
                             static_cast<std::uint32_t>((s.y + n) / 2));
        }
        return index(side, column, row);
    }

  private:
    static std::uint32_t side_of(const Vec3f& d) {
        const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
        if (az >= ax && az >= ay) return d.z < 0 ? 5 : 4;
        if (ax >= ay) return d.x < 0 ? 1 : 0;
        return d.y < 0 ? 3 : 2;
    }
    /// The position along one angle, in cells. @pre |p| <= m
    float along(float p, float m) const {
        const auto n = static_cast<float>(n_);
        return std::min(std::max((atan2_polynomial(p, m) * (2 / kPi) + 0.5F) * n, 0.0F), n);
    }
    /// tan(pi / 4 (2 i / n - 1)); exactly 1 in magnitude at a border, and exactly antisymmetric.
    double tangent(std::uint32_t i) const {
        const std::int64_t from_middle = 2 * std::int64_t{i} - n_;
        const auto distance = static_cast<std::uint64_t>(from_middle < 0 ? -from_middle : from_middle);
        if (distance == static_cast<std::uint64_t>(n_)) return from_middle < 0 ? -1 : 1;
        const CirclePoint point = circle_point(distance, 8 * static_cast<std::uint64_t>(n_));
        const double t = point.sine / point.cosine;
        return from_middle < 0 ? -t : t;
    }
    /// Calls use(side, p / m, q / m) for the samples in the order of their indices.
    template <typename Use>
    void for_all_samples(const Use& use) const {
        std::vector<double> tangents(width_);
        for (std::uint32_t i = 0; i < width_; ++i) tangents[i] = tangent(i);
        for (std::uint32_t side = 0; side < 6; ++side)
            for (const double q : tangents)
                for (const double p : tangents) use(side, p, q);
    }

    std::int32_t n_;
    std::uint32_t width_;
};

} // namespace echinus
