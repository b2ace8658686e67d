#include "geometry/parallel.hpp"

#include <algorithm>

#ifdef ECHINUS_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#endif

namespace echinus {

#ifdef ECHINUS_WITH_TBB

namespace {

int concurrency(unsigned thread_count) {
    // oneTBB prints a warning if more threads are requested than it has.
    const int available = tbb::info::default_concurrency();
    return thread_count == 0 ? available
                             : static_cast<int>(std::min(static_cast<unsigned>(available), thread_count));
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

void for_each_piece(std::size_t count, unsigned thread_count,
                    const std::function<void(std::size_t begin, std::size_t end)>& answer) noexcept {
    constexpr std::size_t kFewest = 1 << 14; // fewer items are not worth a thread
    constexpr std::size_t kMost = 1 << 30;
    const std::size_t wanted =
        thread_count == 1 ? 1 : std::min(2 * worker_count(thread_count), count / kFewest);
    const std::size_t pieces = std::max({wanted, (count + kMost - 1) / kMost, std::size_t{1}});
    const auto answer_pieces = [&](std::size_t first, std::size_t last) {
        for (std::size_t piece = first; piece < last; ++piece)
            answer(count / pieces * piece + std::min(piece, count % pieces),
                   count / pieces * (piece + 1) + std::min(piece + 1, count % pieces));
    };
    if (wanted <= 1) {
        answer_pieces(0, pieces);
        return;
    }
    try {
        parallel_for(pieces, thread_count, answer_pieces);
    } catch (...) {
        answer_pieces(0, pieces);
    }
}

} // namespace echinus
