#pragma once

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/export.hpp>

#include <concepts>
#include <variant>

ECHINUS_EXPORT_BEGIN

/// Queries of a map whose kind is known only at run time. They forward to the queries of that kind.
namespace echinus {

using AnyMap = std::variant<DistanceMap, ExactMap>;

// They are templates, so that a map of a known kind is not converted to the variant.

template <std::same_as<AnyMap> Map>
bool contains(const Map& map, Vec3f point_local) noexcept {
    return std::visit([&](const auto& kind) { return contains(kind.view(), point_local); }, map);
}

template <std::same_as<AnyMap> Map>
Contact contact(const Map& map, Vec3f point_local, float margin = 0) noexcept {
    return std::visit([&](const auto& kind) { return contact(kind.view(), point_local, margin); }, map);
}

template <std::same_as<AnyMap> Map>
void contains_batch(const Map& map, StridedSpan<const Vec3f> points_local, std::span<std::uint8_t> inside,
                    unsigned thread_count = 1) noexcept {
    std::visit([&](const auto& kind) { contains_batch(kind.view(), points_local, inside, thread_count); },
               map);
}

template <std::same_as<AnyMap> Map>
void contacts_batch(const Map& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count = 1) noexcept {
    std::visit(
        [&](const auto& kind) { contacts_batch(kind.view(), points_local, margin, contacts, thread_count); },
        map);
}

} // namespace echinus

ECHINUS_EXPORT_END
