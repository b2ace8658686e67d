#pragma once

#include "directions/spherical_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// Componentwise.
template <typename T>
Vec3<T> product(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// The paper's grid in a frame with scaled axes, g = S x, whose unit sphere is an ellipsoid in the mesh's
/// frame: samples, cells and weights are those of the direction S x, and the radial coordinate is |S x|. Rays
/// and planes stay rays and planes in both frames.
class EllipsoidalGrid : public SphericalGrid {
  public:
    /// Thinner meshes are treated as if they had this scale: rays are cast along lattice points, which lie
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
    /// falls with the cube of its distance.
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
    /// No radial coordinate exceeds the distance. In a box with half edges proportional to 1 / scale, the
    /// longest at most the radius, none exceeds that of the box's corner.
    float largest_entry(float radius) const {
        constexpr float kCorner = 1.7320509F; // of the unit cube: sqrt(3), rounded up
        return radius * std::min(1.0F, kCorner * smallest_scale());
    }

    struct Coordinates : SphericalGrid::Coordinates {
        float stretch; ///< Euclidean per radial length along this ray
    };
    /// @param d_grid  as for SphericalGrid
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
