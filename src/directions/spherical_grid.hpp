#pragma once

#include "directions/bilinear_grid.hpp"
#include "directions/lattice.hpp"
#include "geometry/elementary.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/directions.hpp>
#include <echinus/geometry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// The paper's grid of directions (section 2.1): longitude phi_i = 2 pi i / N_phi, periodic, and colatitude
/// theta_j = pi (j + 1/2) / N_theta. The paper does not specify the positions of its samples along theta; the
/// offset of one half keeps them away from the poles, where a whole row would be one direction.
///
/// Inside this class, vectors are in the grid's frame, whose z axis is the pole axis: to_grid() converts to
/// that frame.
class SphericalGrid : public BilinearGrid {
  public:
    SphericalGrid(std::uint32_t longitude_count, std::uint32_t colatitude_count, PoleAxis pole_axis)
        : longitude_count_(longitude_count), colatitude_count_(colatitude_count), pole_axis_(pole_axis) {}

    std::uint32_t longitude_count() const { return longitude_count_; }
    std::uint32_t colatitude_count() const { return colatitude_count_; }
    std::uint32_t index(std::uint32_t longitude, std::uint32_t colatitude) const {
        return colatitude * longitude_count_ + longitude;
    }

    template <typename T>
    Vec3<T> to_grid(const Vec3<T>& v) const {
        return turned_last(pole_axis_, v);
    }
    template <typename T>
    Vec3<T> from_grid(const Vec3<T>& v) const {
        return turned_back(pole_axis_, v);
    }

    std::size_t direction_count() const { return std::size_t{longitude_count_} * colatitude_count_; }

    /// Unit vectors of all samples by index, in the mesh's frame.
    std::vector<Vec3d> directions() const {
        std::vector<CirclePoint> meridians(longitude_count_);
        for (std::uint32_t i = 0; i < longitude_count_; ++i) meridians[i] = circle_point(i, longitude_count_);
        std::vector<Vec3d> result;
        result.reserve(direction_count());
        for (std::uint32_t j = 0; j < colatitude_count_; ++j) {
            const CirclePoint theta = colatitude_point(j);
            for (const CirclePoint& phi : meridians)
                result.push_back(
                    from_grid(Vec3d{theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine}));
        }
        return result;
    }

    /// The directions in which rays are cast.
    std::vector<LatticePoint> lattice_directions() const { return echinus::lattice_directions(directions()); }

    /// The solid angle of each sample, up to a common factor: the sine of the colatitude.
    std::vector<double> solid_angle_weights() const {
        std::vector<double> result;
        result.reserve(direction_count());
        for (std::uint32_t j = 0; j < colatitude_count_; ++j)
            result.insert(result.end(), longitude_count_, colatitude_point(j).sine);
        return result;
    }

    /// Longitude and colatitude in cells, counted from sample 0.
    struct Coordinates {
        float along_phi;   ///< in [-N_phi / 2, N_phi / 2]
        float along_theta; ///< in [-1/2, N_theta - 1/2]
    };

    /// @param d_grid  of any length, in the grid's frame; 0 counts as longitude 0, colatitude 0. Must be
    ///                finite, otherwise the coordinates are meaningless
    Coordinates coordinates_of(const Vec3f& d_grid) const {
        const float horizontal = std::sqrt(d_grid.x * d_grid.x + d_grid.y * d_grid.y);
        const float phi = atan2_polynomial(d_grid.y, d_grid.x);
        const float theta = atan2_polynomial(horizontal, d_grid.z);
        return {phi * (static_cast<float>(longitude_count_) / (2 * kPi)),
                theta * (static_cast<float>(colatitude_count_) / kPi) - 0.5F};
    }

    /// The cell's u is along phi, v along theta.
    Cell cell_at(const Coordinates& at) const {
        const std::int32_t phi_floor = floor_to_int(at.along_phi);
        const std::int32_t j0 = floor_to_int(at.along_theta);
        const std::uint32_t i0 = wrap_longitude(phi_floor);
        const std::uint32_t i1 = i0 + 1 == longitude_count_ ? 0 : i0 + 1;
        return {{corner(i0, j0), corner(i1, j0), corner(i0, j0 + 1), corner(i1, j0 + 1)},
                at.along_phi - static_cast<float>(phi_floor),
                at.along_theta - static_cast<float>(j0)};
    }

    /// @param d_grid  as in coordinates_of()
    Cell locate(const Vec3f& d_grid) const { return cell_at(coordinates_of(d_grid)); }

    /// The gradient of |x| - S(phi, theta) on the map's surface: e_r - S_theta / S e_theta - S_phi / (S sin
    /// theta) e_phi.
    /// @param distance  S; slope_u and slope_v are its derivatives per cell
    Vec3f surface_gradient(const Vec3f& e_r, const Cell&, float distance, float, float slope_u,
                           float slope_v) const {
        const float sine = std::sqrt(e_r.x * e_r.x + e_r.y * e_r.y); // sine of theta
        if (!(sine > 0 && distance > 0)) return e_r; // on the pole axis longitude has no meaning
        const Vec3f e_phi{-e_r.y / sine, e_r.x / sine, 0};
        const Vec3f e_theta = cross(e_phi, e_r);
        const float per_theta = slope_v * (static_cast<float>(colatitude_count_) / kPi) / distance;
        const float per_phi =
            slope_u * (static_cast<float>(longitude_count_) / (2 * kPi)) / (distance * sine);
        return e_r - e_theta * per_theta - e_phi * per_phi;
    }

    /// Calls `visit(corners)` for the polygons between neighbouring samples, with the indices of the corners
    /// counter-clockwise seen from outside. Since theta grows from the pole downwards and phi
    /// counter-clockwise, the corners of a cell are (i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j). The small
    /// polygons around the poles come last.
    template <typename Visit>
    void for_each_facet(const Visit& visit) const {
        for (std::uint32_t j = 0; j + 1 < colatitude_count_; ++j)
            for (std::uint32_t i = 0; i < longitude_count_; ++i) {
                const std::uint32_t next = i + 1 == longitude_count_ ? 0 : i + 1;
                visit(std::array{index(i, j), index(i, j + 1), index(next, j + 1), index(next, j)});
            }
        std::vector<std::uint32_t> pole(longitude_count_);
        for (std::uint32_t i = 0; i < longitude_count_; ++i) pole[i] = index(i, 0);
        visit(pole);
        // Seen from outside, longitude runs clockwise around the other pole.
        for (std::uint32_t i = 0; i < longitude_count_; ++i)
            pole[i] = index(i == 0 ? 0 : longitude_count_ - i, colatitude_count_ - 1);
        visit(pole);
    }

  private:
    /// Avoids std::floor, which is a function call on processors older than SSE4.1.
    static std::int32_t floor_to_int(float value) {
        const auto truncated = truncated_to<std::int32_t>(value);
        return truncated - (static_cast<float>(truncated) > value ? 1 : 0);
    }
    CirclePoint colatitude_point(std::uint32_t j) const {
        return circle_point(2 * std::uint64_t{j} + 1, 4 * std::uint64_t{colatitude_count_});
    }
    /// The index is in [-N/2, N/2], so one addition suffices.
    std::uint32_t wrap_longitude(std::int32_t i) const {
        return static_cast<std::uint32_t>(i < 0 ? i + static_cast<std::int32_t>(longitude_count_) : i);
    }
    /// Beyond a pole the row continues at the opposite longitude (half a sample off if the count is odd).
    std::uint32_t corner(std::uint32_t i, std::int32_t j) const {
        const auto last = static_cast<std::int32_t>(colatitude_count_) - 1;
        if (j >= 0 && j <= last) return index(i, static_cast<std::uint32_t>(j));
        const std::uint32_t half = longitude_count_ / 2;
        const std::uint32_t opposite = i >= half ? i - half : i + half;
        return index(opposite < longitude_count_ ? opposite : 0,
                     j < 0 ? 0U : static_cast<std::uint32_t>(last));
    }

    std::uint32_t longitude_count_;
    std::uint32_t colatitude_count_;
    PoleAxis pole_axis_;
};

/// The componentwise product.
template <typename T>
Vec3<T> product(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// The paper's grid in a frame with scaled axes, g = S x, whose unit sphere is an ellipsoid in the mesh's
/// frame: samples, cells and weights are those of the direction S x, and the radial coordinate is |S x|. Rays
/// and planes remain rays and planes in the other frame.
class EllipsoidalGrid : public SphericalGrid {
  public:
    /// Thinner meshes are treated as if they had this scale: rays are cast along lattice points, which are
    /// farther apart in the scaled frame.
    static constexpr float kSmallestScale = 1.0F / 64;

    /// @param scale  the diagonal of S, along the mesh's axes, each within [kSmallestScale, 1]
    EllipsoidalGrid(std::uint32_t longitude_count, std::uint32_t colatitude_count, PoleAxis pole_axis,
                    const Vec3f& scale)
        : SphericalGrid(longitude_count, colatitude_count, pole_axis), scale_(scale),
          scale_in_grid_(to_grid(scale)) {}

    const Vec3f& scale() const { return scale_; }
    const Vec3f& scale_in_grid() const { return scale_in_grid_; }
    float smallest_scale() const { return std::min({scale_.x, scale_.y, scale_.z}); }

    /// Vectors with a radial coordinate of 1 to all samples by index, in the mesh's frame.
    std::vector<Vec3d> directions() const {
        const Vec3d longer{1 / double{scale_.x}, 1 / double{scale_.y}, 1 / double{scale_.z}};
        std::vector<Vec3d> result = SphericalGrid::directions();
        for (Vec3d& d : result) d = product(d, longer);
        return result;
    }
    std::vector<LatticePoint> lattice_directions() const {
        std::vector<Vec3d> units = directions();
        for (Vec3d& d : units) d = d * (1 / length(d));
        return echinus::lattice_directions(units);
    }
    /// The solid angle of each sample, up to a common factor: that of a small area of the scaled unit sphere
    /// is inversely proportional to the cube of its distance.
    std::vector<double> solid_angle_weights() const {
        std::vector<double> result = SphericalGrid::solid_angle_weights();
        const std::vector<Vec3d> places = directions();
        for (std::size_t i = 0; i < result.size(); ++i) {
            const double l = length(places[i]);
            result[i] /= l * l * l;
        }
        return result;
    }

    double radial_norm(const Vec3d& d) const { return length(product(d, Vec3d(scale_))); }
    float interpolant_at(const Vec3d& d) const { return static_cast<float>(radial_norm(d)); }
    /// No radial coordinate exceeds the distance. In a box whose half edges are proportional to 1 / scale,
    /// the longest being at most the radius, none exceeds that of the box's corner.
    float largest_entry(float radius) const {
        constexpr float kCorner = 1.7320509F; // of the unit cube: sqrt(3), rounded up
        return radius * std::min(1.0F, kCorner * smallest_scale());
    }

    struct Coordinates : SphericalGrid::Coordinates {
        float stretch; ///< Euclidean length divided by radial length along this ray
    };
    /// @param d_grid  as in SphericalGrid
    Coordinates coordinates_of(const Vec3f& d_grid) const {
        const Vec3f g = product(d_grid, scale_in_grid_);
        const float radial = length(g);
        return {SphericalGrid::coordinates_of(g), radial > 0 ? length(d_grid) / radial : 1};
    }
    Cell locate(const Vec3f& d_grid) const { return cell_at(coordinates_of(d_grid)); }

    static float distance_of(float interpolated, const Coordinates& at) { return interpolated * at.stretch; }

    /// The gradient of |g| - S(phi, theta) by the chain rule.
    /// @param value  S; slope_u and slope_v are its derivatives per cell
    Vec3f surface_gradient(const Vec3f& e_r, const Cell& cell, float, float value, float slope_u,
                           float slope_v) const {
        const Vec3f g = product(e_r, scale_in_grid_);
        const Vec3f unit = g * (1 / length(g));
        return product(SphericalGrid::surface_gradient(unit, cell, value, value, slope_u, slope_v),
                       scale_in_grid_);
    }

  private:
    Vec3f scale_, scale_in_grid_;
};

} // namespace echinus
