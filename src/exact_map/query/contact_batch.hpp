#pragma once

#include "exact_map/query/contact_search.hpp"

#include <span>

namespace echinus {

/// The contacts of many particles; the same as by the search, whatever the instruction set.
/// @throws std::bad_alloc
/// @pre points_local.size() == contacts.size()
void find_contacts(const ContactSearch& search, const StridedSpan<const Vec3f>& points_local,
                   std::span<Contact> contacts);

} // namespace echinus
