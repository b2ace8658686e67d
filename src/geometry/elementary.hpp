#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace echinus {

// Elementary functions with the same bits on every machine: those of C libraries differ in their last digits.
// They take only what IEEE 754 rounds in one way: sums, products, quotients, square roots.

/// The sum of ratio^k / (2 k + 1) over k below 13, for the series of both functions. With |ratio| at most
/// 0.04 what is left out is less than rounding.
inline double odd_series(double ratio) {
    double sum = 0;
    for (std::size_t k = 13; k-- > 0;) sum = sum * ratio + 1.0 / static_cast<double>(2 * k + 1);
    return sum;
}

/// The natural logarithm. @pre x is positive, finite and normal
inline double portable_log(double x) {
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent); // exact
    if (mantissa < std::numbers::sqrt2 / 2) {
        mantissa *= 2;
        --exponent;
    }
    const double s = (mantissa - 1) / (mantissa + 1);
    return 2 * s * odd_series(s * s) + exponent * std::numbers::ln2;
}

/// The angle of (x, y), in [-pi, pi]; 0 of the origin.
inline double portable_atan2(double y, double x) {
    const double across = std::abs(y), along = std::abs(x), larger = std::max(across, along);
    if (!(larger > 0)) return 0;
    double tangent = std::min(across, along) / larger;
    // Of a quarter of the angle.
    for (int i = 0; i < 2; ++i) tangent /= 1 + std::sqrt(1 + tangent * tangent);
    double angle = 4 * tangent * odd_series(-tangent * tangent);
    if (across > along) angle = std::numbers::pi / 2 - angle;
    if (x < 0) angle = std::numbers::pi - angle;
    return std::copysign(angle, y);
}

} // namespace echinus
