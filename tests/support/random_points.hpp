#pragma once

#include <echinus/geometry.hpp>

#include <cstdint>
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

/// Random numbers with the same bits on every machine. The standard fixes the output of its engines but not
/// of its distributions, so those are our own, and the normal one uses no function of the C library.
class PortableRandom {
  public:
    explicit PortableRandom(std::uint64_t seed) : engine_(seed) {}

    /// In [0, 1), in steps of 2^-53.
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Mean 0, standard deviation 1, exactly distributed: algorithm N of Karney, "Sampling Exactly from the
    /// Normal Distribution" (2016), with doubles for its digits.
    double normal() {
        while (true) {
            int whole = 0;
            while (happens_with_exp_of_minus(0.5)) ++whole;
            if (!happens_every_time(whole * (whole - 1), 0.5)) continue;
            const double fraction = uniform();
            if (!happens_every_time(whole + 1, fraction * (2 * whole + fraction) / (2 * whole + 2))) continue;
            return uniform() < 0.5 ? whole + fraction : -(whole + fraction);
        }
    }

  private:
    /// With probability exp(-t), for t in [0, 1]: whether a run of ever smaller numbers below t has an even
    /// length (von Neumann 1951).
    bool happens_with_exp_of_minus(double t) {
        bool even = true;
        for (double last = t, next = uniform(); next < last; last = next, next = uniform()) even = !even;
        return even;
    }
    bool happens_every_time(int times, double t) {
        for (int i = 0; i < times; ++i)
            if (!happens_with_exp_of_minus(t)) return false;
        return true;
    }

    std::mt19937_64 engine_;
};

} // namespace echinus::test
