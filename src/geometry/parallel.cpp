#include "geometry/parallel.hpp"

#ifdef ECHINUS_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#endif

namespace echinus {

#ifdef ECHINUS_WITH_TBB

namespace {

int concurrency(unsigned thread_count) {
    // Asked for more threads than it has, oneTBB would print a warning.
    const int available = tbb::info::default_concurrency();
    return thread_count == 0 ? available : std::min(available, static_cast<int>(thread_count));
}

} // namespace

std::size_t worker_count(unsigned thread_count) {
    return thread_count == 1 ? 1 : static_cast<std::size_t>(concurrency(thread_count));
}

void parallel_for_workers(
    std::size_t count, unsigned thread_count,
    const std::function<void(std::size_t worker, std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
    if (worker_count(thread_count) == 1) {
        body(0, 0, count);
        return;
    }
    tbb::task_arena arena(concurrency(thread_count));
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
            body(static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()), range.begin(),
                 range.end());
        });
    });
}

void parallel_invoke(unsigned thread_count, const std::function<void()>& first,
                     const std::function<void()>& second) {
    if (worker_count(thread_count) == 1) {
        first();
        second();
        return;
    }
    tbb::task_arena arena(concurrency(thread_count));
    arena.execute([&] { tbb::parallel_invoke(first, second); });
}

#else

std::size_t worker_count(unsigned) {
    return 1;
}

void parallel_for_workers(
    std::size_t count, unsigned,
    const std::function<void(std::size_t worker, std::size_t begin, std::size_t end)>& body) {
    if (count != 0) body(0, 0, count);
}

void parallel_invoke(unsigned, const std::function<void()>& first, const std::function<void()>& second) {
    first();
    second();
}

#endif

void parallel_for(std::size_t count, unsigned thread_count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    parallel_for_workers(count, thread_count,
                         [&](std::size_t, std::size_t begin, std::size_t end) { body(begin, end); });
}

} // namespace echinus
