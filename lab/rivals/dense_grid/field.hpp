#pragma once

#include "rivals/dense_grid/dense_grid.hpp"

#include <vector>

namespace echinus::rivals {

/// The data that queries read. Samples lie [z][y][x].
struct SampledField {
    Vec3f low, high;          ///< the padded box; the first node is at its low corner
    float nodes_per_unit = 0; ///< 1 / spacing
    double spacing = 0;
    std::int32_t nodes[3]{};
    SampleFormat format = SampleFormat::Float32;
    float step = 1; ///< of a stored number, in the mesh's unit
    std::vector<float> float32;
    std::vector<std::int16_t> snorm16; ///< empty, or float32 is

    std::size_t node_count() const { return float32.size() + snorm16.size(); }
    std::int32_t row() const { return nodes[0]; }
    std::int32_t slice() const { return nodes[0] * nodes[1]; }
    float last(int axis) const { return static_cast<float>(nodes[axis] - 1); }
    /// From differences of stored numbers a spacing apart to slopes.
    float slope_scale() const { return step * nodes_per_unit; }
};

/// Gradients are divided by at least this squared and rooted, so that none is divided by 0.
inline constexpr float kMinGradientSq = 1e-30F;

// The batch queries in vector instructions; simd/dispatch.hpp chooses which. The same operations in the same
// order as DenseGrid::sample(), hence the same bits.

void contains_kernel(const SampledField& field, std::span<const Vec3f> points,
                     std::span<std::uint8_t> inside);

void contacts_kernel(const SampledField& field, std::span<const Vec3f> points,
                     const DenseGrid::Contacts& contacts);

} // namespace echinus::rivals
