#pragma once

#include <echinus/geometry.hpp>

#include <random>

namespace echinus::test {

using Random = std::mt19937;

inline float uniform(Random& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

inline Vec3f in_cube(Random& random, float half_width) {
    const float x = uniform(random, -half_width, half_width);
    const float y = uniform(random, -half_width, half_width);
    return {x, y, uniform(random, -half_width, half_width)};
}

inline Vec3f in_sphere(Random& random, float radius) {
    while (true) {
        const Vec3f point = in_cube(random, radius);
        if (length(point) <= radius) return point;
    }
}

inline Vec3f unit_vector(Random& random) {
    while (true) {
        const Vec3f point = in_cube(random, 1);
        const float l = length(point);
        if (l > 0.01F && l <= 1) return point * (1 / l);
    }
}

} // namespace echinus::test
