#include "rivals/superquadric_map/sampling.hpp"

#include "directions/face_cone.hpp"
#include "directions/samples_near.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echinus::rivals {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// The rays of a grid, and how to find those near a face. Along a row true longitude grows with the column,
/// along a column true colatitude grows with the row, whatever the exponents: so both can be searched by
/// halving.
class RayTable {
  public:
    RayTable(const Superquadric& shape, const SphericalGrid& grid, const std::vector<Vec3d>& points)
        : grid_(grid) {
        directions_.reserve(points.size());
        colatitudes_.resize(points.size());
        for (std::uint32_t index = 0; index < points.size(); ++index) {
            const Vec3d& p = points[index];
            directions_.push_back(lattice_direction(shape.rotation.apply(p * (1 / length(p)))));
            const std::uint32_t row = index / grid.longitude_count(), column = index % grid.longitude_count();
            colatitudes_[std::size_t{column} * grid.colatitude_count() + row] =
                std::atan2(std::hypot(p.x, p.y), p.z);
        }
        const std::uint32_t equator = grid.colatitude_count() / 2;
        for (std::uint32_t column = 0; column < grid.longitude_count(); ++column) {
            const Vec3d& p = points[grid.index(column, equator)];
            const double longitude = std::atan2(p.y, p.x);
            longitudes_.push_back(longitude < 0 ? longitude + kTurn : longitude);
        }
    }

    const LatticePoint& direction(std::uint32_t index) const { return directions_[index]; }

    /// @param cap  in the superquadric's frame
    template <typename Visit>
    void for_each_ray_in(const DirectionCap& cap, const Visit& visit) const {
        if (cap.phi_half_width >= std::numbers::pi) {
            for (std::uint32_t column = 0; column < grid_.longitude_count(); ++column)
                visit_column(cap, column, visit);
            return;
        }
        double from = std::fmod(cap.phi_middle - cap.phi_half_width + 2 * kTurn, kTurn);
        const double to = from + 2 * cap.phi_half_width;
        visit_columns(cap, from, std::min(to, kTurn), visit);
        if (to >= kTurn) visit_columns(cap, 0, to - kTurn, visit);
    }

  private:
    template <typename Visit>
    void visit_columns(const DirectionCap& cap, double from, double to, const Visit& visit) const {
        const auto begin = std::ranges::lower_bound(longitudes_, from);
        const auto end = std::upper_bound(begin, longitudes_.end(), to);
        for (auto column = begin; column != end; ++column)
            visit_column(cap, static_cast<std::uint32_t>(column - longitudes_.begin()), visit);
    }
    template <typename Visit>
    void visit_column(const DirectionCap& cap, std::uint32_t column, const Visit& visit) const {
        const auto first =
            colatitudes_.begin() + static_cast<std::ptrdiff_t>(column) * grid_.colatitude_count();
        const auto last = first + grid_.colatitude_count();
        const auto begin = std::lower_bound(first, last, cap.theta_min);
        const auto end = std::upper_bound(begin, last, cap.theta_max);
        for (auto row = begin; row != end; ++row)
            visit(grid_.index(column, static_cast<std::uint32_t>(row - first)));
    }

    const SphericalGrid& grid_;
    std::vector<LatticePoint> directions_; ///< by index in the grid
    std::vector<double> longitudes_;       ///< [omega_count] in [0, 2 pi), ascending
    std::vector<double> colatitudes_;      ///< [omega_count][eta_count], each column ascending
};

DirectionCap cap_in_frame(const std::array<LatticePoint, 3>& corners, const Rotation& to_frame) {
    return DirectionCap({to_frame.apply(Vec3d(corners[0])), to_frame.apply(Vec3d(corners[1])),
                         to_frame.apply(Vec3d(corners[2]))});
}

} // namespace

ProfilePoint profile_point(const CirclePoint& angle, double exponent) {
    return {signed_power(angle.cosine, exponent), signed_power(angle.sine, exponent)};
}

std::vector<Vec3d> sample_points(const Superquadric& shape, const SphericalGrid& grid) {
    std::vector<ProfilePoint> section;
    for (std::uint32_t column = 0; column < grid.longitude_count(); ++column)
        section.push_back(profile_point(circle_point(column, grid.longitude_count()), shape.omega_exponent));
    std::vector<Vec3d> points;
    points.reserve(grid.direction_count());
    for (std::uint32_t row = 0; row < grid.colatitude_count(); ++row) {
        const ProfilePoint eta = profile_point(eta_of_row(row, grid.colatitude_count()), shape.eta_exponent);
        for (const ProfilePoint& omega : section)
            points.push_back({shape.sizes.x * eta.cosine * omega.cosine,
                              shape.sizes.y * eta.cosine * omega.sine, shape.sizes.z * eta.sine});
    }
    return points;
}

std::vector<float> outermost_crossings(const LatticeMesh& lattice, std::size_t own_face_count,
                                       const Superquadric& shape, const SphericalGrid& grid,
                                       const std::vector<Vec3d>& points) {
    const RayTable rays(shape, grid, points);
    const Rotation to_frame = shape.rotation.inverse();
    std::vector<float> outermost(points.size(), -1), of_hull(points.size(), -1);
    for (std::uint32_t face = 0; face < lattice.faces.size(); ++face) {
        const std::array<LatticePoint, 3> corners = lattice.corners(face);
        const FaceCone cone(corners[0], corners[1], corners[2]);
        if (cone.edge_on()) continue;
        std::vector<float>& farthest = lattice.face_numbers[face] < own_face_count ? outermost : of_hull;
        rays.for_each_ray_in(cap_in_frame(corners, to_frame), [&](std::uint32_t index) {
            const LatticePoint& d = rays.direction(index);
            if (!cone.meets(d)) return;
            const double distance = cone.parameter(d) * length(Vec3d(d)) * lattice.frame.step;
            farthest[index] = std::max(farthest[index], static_cast<float>(distance));
        });
    }
    for (std::size_t i = 0; i < points.size(); ++i)
        if (outermost[i] < 0) outermost[i] = of_hull[i];
    return outermost;
}

} // namespace echinus::rivals
