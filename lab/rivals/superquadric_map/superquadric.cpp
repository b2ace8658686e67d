#include "rivals/superquadric_map/superquadric.hpp"

#include "directions/face_cone.hpp"
#include "directions/samples_near.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echinus::rivals {

double signed_power(double base, double exponent) {
    return std::copysign(std::pow(std::fabs(base), exponent), base);
}

double Superquadric::log_inside_outside(const Vec3d& place) const {
    return LogPowers(place, sizes, eta_exponent, omega_exponent).whole;
}

double Superquadric::factor_to_surface(const Vec3d& place) const {
    return std::exp(-eta_exponent / 2 * log_inside_outside(place));
}

double Superquadric::radial_distance(const Vec3d& point) const {
    const Vec3d place = to_frame(point);
    return length(place) * (1 - factor_to_surface(place));
}

SuperquadricAngles Superquadric::angles_of(const Vec3d& place) const {
    const LogPowers powers(place, sizes, eta_exponent, omega_exponent);
    // tan^2(omega) = Y / X and tan^2(eta) = Z / D: each term is the square of a sine or a cosine but for a
    // factor.
    const auto angle = [](double log_sine_sq, double sine_sign, double log_cosine_sq, double cosine_sign) {
        const double largest = std::max(log_sine_sq, log_cosine_sq);
        if (std::isinf(largest)) return 0.0;
        return std::atan2(std::copysign(std::exp((log_sine_sq - largest) / 2), sine_sign),
                          std::copysign(std::exp((log_cosine_sq - largest) / 2), cosine_sign));
    };
    return {angle(powers.z, place.z, powers.disc, 1), angle(powers.y, place.y, powers.x, place.x)};
}

Vec3d Superquadric::surface_point(const SuperquadricAngles& angles) const {
    const double cos_eta = signed_power(std::cos(angles.eta), eta_exponent);
    return {sizes.x * cos_eta * signed_power(std::cos(angles.omega), omega_exponent),
            sizes.y * cos_eta * signed_power(std::sin(angles.omega), omega_exponent),
            sizes.z * signed_power(std::sin(angles.eta), eta_exponent)};
}

TriangleMesh tessellate(const Superquadric& shape, std::uint32_t eta_count, std::uint32_t omega_count) {
    constexpr double kPiDouble = std::numbers::pi;
    TriangleMesh mesh;
    mesh.vertices.push_back(Vec3f(shape.from_frame({0, 0, -shape.sizes.z})));
    for (std::uint32_t row = 1; row < eta_count; ++row)
        for (std::uint32_t column = 0; column < omega_count; ++column)
            mesh.vertices.push_back(Vec3f(shape.from_frame(shape.surface_point(
                {kPiDouble * row / eta_count - kPiDouble / 2, 2 * kPiDouble * column / omega_count}))));
    mesh.vertices.push_back(Vec3f(shape.from_frame({0, 0, shape.sizes.z})));

    const auto top = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    const auto ring = [&](std::uint32_t row, std::uint32_t column) {
        return 1 + (row - 1) * omega_count + column % omega_count;
    };
    for (std::uint32_t column = 0; column < omega_count; ++column) {
        mesh.faces.push_back({0, ring(1, column + 1), ring(1, column)});
        for (std::uint32_t row = 1; row + 1 < eta_count; ++row) {
            const std::uint32_t a = ring(row, column), b = ring(row, column + 1);
            const std::uint32_t c = ring(row + 1, column + 1), d = ring(row + 1, column);
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
        mesh.faces.push_back({ring(eta_count - 1, column), ring(eta_count - 1, column + 1), top});
    }
    return mesh;
}

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
