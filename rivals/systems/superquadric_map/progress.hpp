#pragma once

#include <functional>
#include <string_view>

namespace echinus::rivals {

/// Told by a build that takes long what it does and how much of that is done, 0 to 1. From one thread at a
/// time. What it throws ends the build and reaches the caller.
using Progress = std::function<void(std::string_view stage, double share)>;

} // namespace echinus::rivals
