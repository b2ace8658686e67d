#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace echinus {

// Elementary functions with the same bits on every machine: those of C libraries differ in the last digits,
// but maps and answers must be the same everywhere. They use only operations that IEEE 754 rounds in exactly
// one way: addition, subtraction, multiplication, division and square root.

/// The sum of ratio^k / (2 k + 1) over k below 13, for the series of both functions below. If |ratio| is at
/// most 0.04, the omitted terms are less than the rounding error.
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

/// The angle of (x, y), in [-pi, pi]; 0 for the origin, NaN for NaN. The sign of a zero y distinguishes pi
/// from -pi. @pre not both are infinite
inline double portable_atan2(double y, double x) {
    const double across = std::abs(y), along = std::abs(x);
    if (across + along == 0) return 0;
    const bool is_steep = across > along;
    double tangent = is_steep ? along / across : across / along;
    // The tangent of a quarter of the angle.
    for (int i = 0; i < 2; ++i) tangent /= 1 + std::sqrt(1 + tangent * tangent);
    double angle = 4 * tangent * odd_series(-tangent * tangent);
    if (is_steep) angle = std::numbers::pi / 2 - angle;
    if (x < 0) angle = std::numbers::pi - angle;
    return std::copysign(angle, y);
}

/// The cube root. @pre x is finite and not negative
inline double portable_cbrt(double x) {
    if (x == 0) return 0;
    int exponent = 0;
    double scaled = std::frexp(x, &exponent); // exact
    for (; exponent % 3 != 0; --exponent) scaled *= 2;
    double root = (2 + scaled) / 3; // the tangent at 1, within 0.42 for scaled in [0.5, 4)
    // Halley's method, each step of which cubes the error.
    for (int i = 0; i < 4; ++i) {
        const double cube = root * root * root;
        root *= (cube + 2 * scaled) / (2 * cube + scaled);
    }
    return std::ldexp(root, exponent / 3);
}

inline constexpr float kPi = std::numbers::pi_v<float>;

/// atan(ratio) / ratio on [0, 1] as a polynomial in ratio^2, minimax to 4e-8; the highest power first.
inline constexpr std::array<float, 8> kAtanCoefficients{-0.0040545650F, 0.0218629502F,  -0.0559123196F,
                                                        0.0964219445F,  -0.1390862912F, 0.1994656622F,
                                                        -0.3332985938F, 0.9999993443F};

/// The angle of (x, y), counter-clockwise from the x axis, in [-pi, pi]; 0 for the origin. The sign of a zero
/// y distinguishes pi from -pi. The error is at most 4e-7 rad, 1/40 000 of a cell if 200 samples span half a
/// turn. Meaningless for NaN and infinity.
inline float atan2_polynomial(float y, float x) {
    const float ax = std::fabs(x);
    const float ay = std::fabs(y);
    const float larger = ax > ay ? ax : ay;
    const float smaller = ax > ay ? ay : ax;
    const float ratio = larger > 0 ? smaller / larger : 0;
    const float s = ratio * ratio;
    float p = kAtanCoefficients[0];
    for (std::size_t i = 1; i < kAtanCoefficients.size(); ++i) p = p * s + kAtanCoefficients[i];
    float angle = p * ratio;
    if (ay > ax) angle = kPi / 2 - angle;
    if (x < 0) angle = kPi - angle;
    return std::copysign(angle, y);
}

/// A point of the unit circle.
struct CirclePoint {
    double cosine = 1;
    double sine = 0;
};

/// The point at 2 pi * index / count, within 1e-15 of the true one. Unlike std::sin and std::cos it gives the
/// same bits on every machine, and the points are exactly symmetric: index and count - index differ only in
/// the sign of the sine, and multiples of a quarter turn have no rounding error.
/// @pre count > 0 and both are at most 2^60
CirclePoint circle_point(std::uint64_t index, std::uint64_t count);

} // namespace echinus
