#pragma once

#include <echinus/distance_map.hpp>

/// The batches of query.cpp for many particles at a time, with the same bits as one by one.
namespace echinus {

/// Can the kernels read this map? Not when it is too small to be worth it, or its arrays are too large for
/// 32-bit positions.
bool kernels_read(const DistanceMapView& map) noexcept;

/// @pre kernels_read(map), use_kernels()
void contains_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        std::span<std::uint8_t> inside) noexcept;

/// @pre as above; margin >= 0
void contacts_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        float margin, std::span<Contact> contacts) noexcept;

} // namespace echinus
