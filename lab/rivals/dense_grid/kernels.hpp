#pragma once

#include "rivals/dense_grid/field.hpp"

/// The batch queries in vector instructions; simd/dispatch.hpp chooses which. The same operations in the same
/// order as DenseGrid::sample(), hence the same bits.
namespace echinus::rivals {

void contains_kernel(const SampledField& field, std::span<const Vec3f> points,
                     std::span<std::uint8_t> inside);

void contacts_kernel(const SampledField& field, std::span<const Vec3f> points,
                     const DenseGrid::Contacts& contacts);

} // namespace echinus::rivals
