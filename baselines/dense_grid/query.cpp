#include "baselines/dense_grid/dense_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace echinus::baselines {

namespace {

constexpr std::size_t kBlock = 512; // in the first-level cache, with room to spare

/// The grid as numbers in registers.
struct Field {
    const float* samples;
    Vec3f low;
    float nodes_per_unit;
    float last_x, last_y, last_z; ///< the last node along each axis
    std::int32_t row, slice;      ///< nodes

    Field(std::span<const float> samples_, const Vec3f& low_, float nodes_per_unit_,
          const std::uint32_t (&nodes)[3])
        : samples(samples_.data()), low(low_), nodes_per_unit(nodes_per_unit_),
          last_x(static_cast<float>(nodes[0] - 1)), last_y(static_cast<float>(nodes[1] - 1)),
          last_z(static_cast<float>(nodes[2] - 1)), row(static_cast<std::int32_t>(nodes[0])),
          slice(static_cast<std::int32_t>(nodes[0] * nodes[1])) {}
};

struct Cell {
    std::int32_t first; ///< its lowest corner's sample
    float x, y, z;      ///< within it, 0 to 1
};

/// From 0 to `last`; 0 for NaN.
inline float clamped(float coordinate, float last) {
    const float from_zero = coordinate > 0 ? coordinate : 0;
    return from_zero < last ? from_zero : last;
}

inline Cell cell_of(const Field& field, const Vec3f& p) {
    const float x = clamped((p.x - field.low.x) * field.nodes_per_unit, field.last_x);
    const float y = clamped((p.y - field.low.y) * field.nodes_per_unit, field.last_y);
    const float z = clamped((p.z - field.low.z) * field.nodes_per_unit, field.last_z);
    // The last node belongs to the last cell.
    const auto i = static_cast<std::int32_t>(std::min(x, field.last_x - 1));
    const auto j = static_cast<std::int32_t>(std::min(y, field.last_y - 1));
    const auto k = static_cast<std::int32_t>(std::min(z, field.last_z - 1));
    return {k * field.slice + j * field.row + i, x - static_cast<float>(i), y - static_cast<float>(j),
            z - static_cast<float>(k)};
}

inline float mix(float a, float b, float t) {
    return a + (b - a) * t;
}

} // namespace

void DenseGrid::contains_batch(std::span<const Vec3f> points, std::span<std::uint8_t> inside) const noexcept {
    const Field f(samples_, low_, nodes_per_unit_, node_counts_);
    std::array<float, kBlock> distances;
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
        const std::size_t count = std::min(kBlock, points.size() - begin);
        const Vec3f* const p = points.data() + begin;
        std::uint8_t* const out = inside.data() + begin;
#pragma omp simd
        for (std::size_t n = 0; n < count; ++n) {
            const Cell c = cell_of(f, p[n]);
            const auto s = [&, first = c.first](std::int32_t offset) { return f.samples[first + offset]; };
            const float s00 = mix(s(0), s(1), c.x), s10 = mix(s(f.row), s(f.row + 1), c.x);
            const float s01 = mix(s(f.slice), s(f.slice + 1), c.x);
            const float s11 = mix(s(f.slice + f.row), s(f.slice + f.row + 1), c.x);
            distances[n] = mix(mix(s00, s10, c.y), mix(s01, s11, c.y), c.z);
        }
        for (std::size_t n = 0; n < count; ++n) out[n] = distances[n] < 0;
    }
}

void DenseGrid::contacts_batch(std::span<const Vec3f> points, const Contacts& contacts) const noexcept {
    const Field f(samples_, low_, nodes_per_unit_, node_counts_);
    float* const depths = contacts.depths.data();
    float* const normals_x = contacts.normals_x.data();
    float* const normals_y = contacts.normals_y.data();
    float* const normals_z = contacts.normals_z.data();
    const Vec3f* const p = points.data();
#pragma omp simd
    for (std::size_t n = 0; n < points.size(); ++n) {
        const Cell c = cell_of(f, p[n]);
        const auto s = [&, first = c.first](std::int32_t offset) { return f.samples[first + offset]; };
        const float a = s(0), b = s(1), d = s(f.row), e = s(f.row + 1);
        const float g = s(f.slice), h = s(f.slice + 1), k = s(f.slice + f.row), l = s(f.slice + f.row + 1);
        const float low_y = mix(a, b, c.x), high_y = mix(d, e, c.x);
        const float low_yz = mix(g, h, c.x), high_yz = mix(k, l, c.x);
        const float low_z = mix(low_y, high_y, c.y), high_z = mix(low_yz, high_yz, c.y);
        const float gradient_x = mix(mix(b - a, e - d, c.y), mix(h - g, l - k, c.y), c.z);
        const float gradient_y = mix(high_y - low_y, high_yz - low_yz, c.z);
        const float gradient_z = high_z - low_z;
        const float length_sq = gradient_x * gradient_x + gradient_y * gradient_y + gradient_z * gradient_z;
        const float scale = 1 / std::sqrt(std::max(length_sq, 1e-30F));
        depths[n] = -mix(low_z, high_z, c.z);
        normals_x[n] = gradient_x * scale;
        normals_y[n] = gradient_y * scale;
        normals_z[n] = gradient_z * scale;
    }
}

} // namespace echinus::baselines
