#include "geometry/parallel.hpp"

#ifdef ECHINUS_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#endif

namespace echinus {

void parallel_for(std::size_t count, unsigned thread_count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
#ifdef ECHINUS_WITH_TBB
    if (thread_count != 1) {
        // Asked for more threads than it has, oneTBB would print a warning.
        const int available = tbb::info::default_concurrency();
        tbb::task_arena arena(thread_count == 0 ? available
                                                : std::min(available, static_cast<int>(thread_count)));
        arena.execute([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                              [&](const auto& range) { body(range.begin(), range.end()); });
        });
        return;
    }
#endif
    (void)thread_count;
    body(0, count);
}

} // namespace echinus
