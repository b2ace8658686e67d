#pragma once

#include "directions/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace echinus {

/// A range of colatitudes and longitudes (grid frame, radians) that contains every direction in which the
/// origin sees a face: the range of a cap around the face's three corners. It only has to be large enough, so
/// the C library's functions suffice; which of its directions meet the face is decided exactly afterwards.
struct DirectionCap {
    double theta_min, theta_max;
    double phi_middle, phi_half_width; ///< a half width of pi or more is the whole circle

    /// Far above the rounding of these lines and of snapping a direction (2e-6 rad), far below a cell.
    static constexpr double kMargin = 1e-5;

    /// @param margin  larger where the frame is scaled and directions were snapped before
    explicit DirectionCap(const std::array<Vec3d, 3>& corners, double margin = kMargin) {
        constexpr double kPiDouble = std::numbers::pi;

        std::array<Vec3d, 3> units;
        for (int i = 0; i < 3; ++i) units[i] = corners[i] * (1 / length(corners[i]));
        const Vec3d sum = units[0] + units[1] + units[2];
        const Vec3d axis = sum * (1 / std::max(length(sum), 1e-300));
        double cosine = 1;
        for (const Vec3d& unit : units) cosine = std::min(cosine, dot(axis, unit));
        // A cap of a quarter turn or more need not contain the great circles between its points: take all
        // directions.
        const double radius = cosine > 0.01 ? std::acos(std::min(cosine, 1.0)) + margin : kPiDouble;

        const double theta = std::atan2(std::hypot(axis.x, axis.y), axis.z);
        theta_min = theta - radius;
        theta_max = theta + radius;
        const bool holds_a_pole = theta_min <= 0 || theta_max >= kPiDouble;
        phi_middle = std::atan2(axis.y, axis.x);
        phi_half_width =
            holds_a_pole ? kPiDouble : std::asin(std::min(1.0, std::sin(radius) / std::sin(theta))) + margin;
    }
};

} // namespace echinus
