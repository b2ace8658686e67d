#pragma once

#include <echinus/geometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace echinus {

/// How far a pair that lies `gap` apart may close: a sixteenth of the gap remains, so that rounding has no
/// say, and `least_gap` always.
inline float usable_gap(float gap, float least_gap) {
    return gap - std::max(least_gap, gap * (1.0F / 16));
}

/// The shares of a vertex's way that nothing forbids, from 0 (where it begins) to 1 (its goal). None where
/// least > most.
struct Shares {
    /// No way leads quite to where its share ends.
    static constexpr float kAlmost = 1 - 1.0F / (1 << 12);

    float least = 0, most = 1;

    bool none() const { return least > most; }

    void keep(const Shares& others) {
        least = std::max(least, others.least);
        most = std::min(most, others.most);
    }
    /// Keeps those where a function that is linear on the way is not negative.
    void keep_not_negative(float at_start, float at_goal) {
        if (at_start >= 0 && at_goal >= 0) return;
        if (at_start < 0 && at_goal < 0)
            keep({1, 0});
        else if (at_start >= 0)
            keep({0, at_start / (at_start - at_goal) * kAlmost});
        else
            keep({1 - at_goal / (at_goal - at_start) * kAlmost, 1});
    }
    /// Keeps those for which |offset + share * way| is at most the radius: between the roots of a quadratic.
    void keep_in_ball(const Vec3f& offset, const Vec3f& way, float radius) {
        if (radius == std::numeric_limits<float>::infinity()) return;
        const float a = dot(way, way), b = dot(way, offset);
        const float c = dot(offset, offset) - radius * std::fabs(radius);
        const float discriminant = b * b - a * c;
        if (!(a > 0) || !(discriminant >= 0)) {
            if (!(c <= 0)) keep({1, 0});
            return;
        }
        const float root = std::sqrt(discriminant);
        keep({(-b - root) / a, (-b + root) / a * kAlmost});
    }
};

} // namespace echinus
