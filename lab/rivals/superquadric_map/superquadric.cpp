#include "rivals/superquadric_map/superquadric.hpp"

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

} // namespace echinus::rivals
