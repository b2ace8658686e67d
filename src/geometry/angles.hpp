#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace echinus {

// Angles from our own polynomials: the C library's atan2, sin and cos differ between systems in the last
// bit, while maps and answers must be the same everywhere.

inline constexpr float kPi = std::numbers::pi_v<float>;

/// atan(ratio) / ratio on [0, 1] as a polynomial in ratio^2, minimax to 4e-8; the highest power first.
inline constexpr std::array<float, 8> kAtanCoefficients{-0.0040545650F, 0.0218629502F,  -0.0559123196F,
                                                        0.0964219445F,  -0.1390862912F, 0.1994656622F,
                                                        -0.3332985938F, 0.9999993443F};

/// The angle of (x, y), counter-clockwise from the x axis, in [-pi, pi]. Error at most 4e-7 rad, a 40 000th
/// of a cell of 200 samples. atan2(0, 0) is 0; the sign of a zero y distinguishes pi from -pi. Not for NaN or
/// infinity.
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
