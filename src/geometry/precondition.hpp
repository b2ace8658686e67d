#pragma once

#include <echinus/export.hpp>

#include <cstddef>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Calls the handler for violated preconditions (error.hpp) if the condition does not hold.
/// @return whether the condition holds; otherwise the caller must return
bool is_met(bool condition, const char* sentence);
/// Like is_met(), for an index that must be less than a count; the message states both.
/// @param name  the singular of what is counted, such as "collider"
bool is_in_range(std::size_t index, std::size_t count, const char* name);

} // namespace echinus

ECHINUS_EXPORT_END
