#pragma once

#include "rivals/classified_grid/layout.hpp"

#include <echinus/contact.hpp>

#include <span>

/// The batch queries in vector instructions; simd/dispatch.hpp chooses which.
namespace echinus::rivals {

void contains_kernel(const GridArrays& grid, std::span<const Vec3f> points_local,
                     std::span<std::uint8_t> inside);

void contacts_kernel(const GridArrays& grid, std::span<const Vec3f> points_local, float margin,
                     std::span<Contact> contacts);

} // namespace echinus::rivals
