#pragma once

#include "contacts/system.hpp"

#include <echinus/contact.hpp>

/// A way that writes Contact.
/// @param fill  void (std::span<const Vec3f> points, std::span<Contact> contacts)
template <typename Fill>
ContactsWay contact_way(std::string name, std::size_t point_count, Fill fill) {
    const auto answers = std::make_shared<std::vector<echinus::Contact>>(point_count);
    return {std::move(name),
            [=](std::span<const echinus::Vec3f> points, std::size_t first) {
                fill(points, std::span(*answers).subspan(first, points.size()));
            },
            [=](std::size_t i) {
                const echinus::Contact& contact = (*answers)[i];
                return contact.inside ? DepthNormal{contact.depth, contact.normal} : DepthNormal{};
            }};
}
