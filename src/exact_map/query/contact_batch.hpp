#pragma once

#include "exact_map/query/contact_search.hpp"

#include <span>

namespace echinus {

/// The contacts of many particles; the same as by the search, whatever the instruction set.
/// @throws std::bad_alloc
/// @pre points_local.size() == contacts.size()
void find_contacts(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                   std::span<Contact> contacts);

/// The signed distances, and the gradients if asked for, in the same way.
/// @param search     finds everything, however far
/// @param gradients  empty, or as long as `distances`
void find_signed_distances(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                           std::span<float> distances, std::span<Vec3f> gradients);

} // namespace echinus
