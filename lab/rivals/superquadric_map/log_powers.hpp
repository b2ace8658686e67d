#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus::rivals {

/// ln(e^a + e^b) without overflow; minus infinity stands for ln 0.
inline double log_of_sum(double a, double b) {
    const double largest = std::max(a, b);
    if (std::isinf(largest)) return largest;
    return largest + std::log1p(std::exp(std::min(a, b) - largest));
}

/// The terms of a superquadric's inside-outside function as logarithms: powers of 2 / 0.1 = 20 leave the
/// range of floating point long before the place is far away.
struct LogPowers {
    double x, y, z; ///< of (x / a1)^(2/e2), (y / a2)^(2/e2), (z / a3)^(2/e1)
    double section; ///< of the sum of the first two
    double disc;    ///< of that sum to the power e2 / e1
    double whole;   ///< of F

    LogPowers(const Vec3d& place, const Vec3d& sizes, double eta_exponent, double omega_exponent)
        : x(2 / omega_exponent * std::log(std::fabs(place.x) / sizes.x)),
          y(2 / omega_exponent * std::log(std::fabs(place.y) / sizes.y)),
          z(2 / eta_exponent * std::log(std::fabs(place.z) / sizes.z)), section(log_of_sum(x, y)),
          disc(omega_exponent / eta_exponent * section), whole(log_of_sum(disc, z)) {}
};

} // namespace echinus::rivals
