#pragma once

#include <cstddef>
#include <functional>

namespace echinus {

/// Calls `body(begin, end)` for consecutive ranges that together are [0, count), on up to `thread_count`
/// threads (0: all cores). Ranges differ between runs and machines, so a body must not let its result depend
/// on where they are cut. Exceptions of the body reach the caller. Without oneTBB: one range, this thread.
void parallel_for(std::size_t count, unsigned thread_count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

} // namespace echinus
