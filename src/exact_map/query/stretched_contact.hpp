#pragma once

#include <echinus/contact.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/geometry.hpp>

#include <span>

/// contact() and contacts_batch() of exact_map.hpp in a world that is scaled along the map's axes, for
/// colliders.
///
/// The nearest point, depth, normal and margin are those of the stretched mesh; points are local.
/// @param stretch  the world's scale along the map's axes; no component is 0, and a negative one mirrors
namespace echinus {

Contact stretched_contact(const ExactMapView& map, const Vec3f& point_local, float margin,
                          const Vec3d& stretch) noexcept;

/// @pre points_local.size() == contacts.size()
void stretched_contacts_batch(const ExactMapView& map, const StridedSpan<const Vec3f>& points_local,
                              float margin, std::span<Contact> contacts, const Vec3d& stretch,
                              unsigned thread_count = 1) noexcept;

} // namespace echinus
