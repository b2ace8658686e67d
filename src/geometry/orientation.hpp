#pragma once

#include <echinus/geometry.hpp>

#include <cmath>

/// The side on which a point lies, decided exactly for all finite floats: by a sum in double and, if its
/// rounding could matter, by a sum without rounding. Filters and error bounds: Shewchuk 1997, "Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates". Products of three floats
/// neither overflow nor underflow in double, so the bounds hold for all floats.
namespace echinus {

/// A point of a plane; its coordinates are floats, so that they and their products are exact in double.
struct Point2 {
    double x, y;
};

int exact_orientation(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) noexcept;
int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept;

/// Sign of (a - d) . ((b - d) x (c - d)): 1 if a, b, c turn clockwise seen from d, -1 if counter-clockwise, 0
/// if all four are coplanar.
/// @pre finite
inline int orientation(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) noexcept {
    constexpr double kErrorBound = 7.77156117237610e-16; // (7 + 56 e) e, e = 2^-53
    const Vec3d origin(d);
    const Vec3d u = Vec3d(a) - origin, v = Vec3d(b) - origin, w = Vec3d(c) - origin;
    const double vxwy = v.x * w.y, vywx = v.y * w.x;
    const double wxuy = w.x * u.y, wyux = w.y * u.x;
    const double uxvy = u.x * v.y, uyvx = u.y * v.x;
    const double determinant = u.z * (vxwy - vywx) + v.z * (wxuy - wyux) + w.z * (uxvy - uyvx);
    const double magnitude = (std::abs(vxwy) + std::abs(vywx)) * std::abs(u.z) +
                             (std::abs(wxuy) + std::abs(wyux)) * std::abs(v.z) +
                             (std::abs(uxvy) + std::abs(uyvx)) * std::abs(w.z);
    if (std::abs(determinant) > kErrorBound * magnitude) return determinant > 0 ? 1 : -1;
    if (magnitude == 0) return 0;
    return exact_orientation(a, b, c, d);
}

/// 1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they are collinear.
/// @pre finite
inline int orientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    constexpr double kErrorBound = 3.33066907387547e-16; // (3 + 16 e) e
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double magnitude = std::abs(left) + std::abs(right);
    if (std::abs(left - right) > kErrorBound * magnitude) return left > right ? 1 : -1;
    if (magnitude == 0) return 0;
    return exact_orientation(a, b, c);
}

} // namespace echinus
