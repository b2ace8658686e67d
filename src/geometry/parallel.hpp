#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <functional>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Calls `body(begin, end)` for consecutive ranges that together are [0, count), on up to `thread_count`
/// threads (0: all cores). Ranges differ between runs and machines, so a body must not let its result depend
/// on where they are cut. Exceptions of the body reach the caller. Without oneTBB: one range, this thread.
void parallel_for(std::size_t count, unsigned thread_count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// How many workers parallel_for_workers() has with so many threads.
std::size_t worker_count(unsigned thread_count);

/// parallel_for() whose body learns which worker runs it, a number below worker_count(thread_count). No two
/// calls with one number overlap in time, so each worker can have memory of its own. Which worker gets which
/// ranges is left to chance. @pre the body starts no parallel loop itself
void parallel_for_workers(
    std::size_t count, unsigned thread_count,
    const std::function<void(std::size_t worker, std::size_t begin, std::size_t end)>& body);

/// Calls `answer(begin, end)` for pieces of a batch that together are [0, count), on up to `thread_count`
/// threads where the batch is large enough to gain by it. No piece has more than 2^30 items.
/// Should no thread or no memory be had, this thread does what is left to do, and perhaps some of it again.
void for_each_piece(std::size_t count, unsigned thread_count,
                    const std::function<void(std::size_t begin, std::size_t end)>& answer) noexcept;
template <typename Answer>
void for_each_piece(std::size_t count, unsigned thread_count, const Answer& answer) noexcept {
    // A reference fits into a std::function; what a lambda captures may need memory, which may fail.
    const std::function<void(std::size_t, std::size_t)> reference = std::cref(answer);
    for_each_piece(count, thread_count, reference);
}

/// Calls both, at the same time if there are two threads for it. Exceptions reach the caller.
void parallel_invoke(unsigned thread_count, const std::function<void()>& first,
                     const std::function<void()>& second);

} // namespace echinus

ECHINUS_EXPORT_END
