#pragma once

#include <echinus/export.hpp>

#include <cstddef>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Calls the handler of violated preconditions (error.hpp) where the condition does not hold.
/// @return whether it holds; otherwise the caller has to return
bool is_met(bool condition, const char* sentence);
/// As is_met(), for an index that must be less than a count; the sentence states both.
/// @param name  of what is counted, such as "collider"
bool is_in_range(std::size_t index, std::size_t count, const char* name);

} // namespace echinus

ECHINUS_EXPORT_END
