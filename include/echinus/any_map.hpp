#pragma once

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <variant>

/// Two maps, one vocabulary: who need not care which kind of map there is, asks here.
namespace echinus {

using AnyMap = std::variant<DistanceMap, ExactMap>;

inline bool contains(const AnyMap& map, Vec3f point_local) noexcept {
    return std::visit([&](const auto& kind) { return contains(kind.view(), point_local); }, map);
}

inline Contact contact(const AnyMap& map, Vec3f point_local, float margin = 0) noexcept {
    return std::visit([&](const auto& kind) { return contact(kind.view(), point_local, margin); }, map);
}

inline void contains_batch(const AnyMap& map, StridedSpan<const Vec3f> points_local,
                           std::span<std::uint8_t> inside) noexcept {
    std::visit([&](const auto& kind) { contains_batch(kind.view(), points_local, inside); }, map);
}

inline void contacts_batch(const AnyMap& map, StridedSpan<const Vec3f> points_local, float margin,
                           std::span<Contact> contacts) noexcept {
    std::visit([&](const auto& kind) { contacts_batch(kind.view(), points_local, margin, contacts); }, map);
}

} // namespace echinus
