#pragma once

#include <echinus/export.hpp>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Calls the handler of violated preconditions (error.hpp) where the condition does not hold.
/// @return whether it holds; otherwise the caller has to return
bool is_met(bool condition, const char* sentence);

} // namespace echinus

ECHINUS_EXPORT_END
