#pragma once

#include <echinus/export.hpp>

#include <cstddef>
#include <functional>
#include <span>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// Calls `body(begin, end)` for consecutive ranges that together cover [0, count), on up to `thread_count`
/// threads (0: all cores). The ranges differ between runs and machines, so the result must not depend on
/// where they are cut. Exceptions of the body reach the caller. Without oneTBB, this thread processes one
/// range.
void parallel_for(std::size_t count, unsigned thread_count,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// The number of workers that parallel_for_workers() uses for this many threads.
std::size_t worker_count(unsigned thread_count);

/// parallel_for() that also passes the body its worker's number, below worker_count(thread_count). No two
/// calls with the same number overlap in time, so each worker can have its own memory. The assignment of
/// ranges to workers is arbitrary. @pre the body starts no parallel loop itself
void parallel_for_workers(
    std::size_t count, unsigned thread_count,
    const std::function<void(std::size_t worker, std::size_t begin, std::size_t end)>& body);

/// Calls `answer(begin, end)` for pieces of a batch that together cover [0, count), on up to `thread_count`
/// threads if the batch is large enough to benefit. No piece has more than 2^30 items. If no thread or no
/// memory is available, this thread does the remaining work, possibly repeating some of it.
void for_each_piece(std::size_t count, unsigned thread_count,
                    const std::function<void(std::size_t begin, std::size_t end)>& answer) noexcept;
template <typename Answer>
void for_each_piece(std::size_t count, unsigned thread_count, const Answer& answer) noexcept {
    // A std::function can hold a reference without allocating; the captures of a lambda may need memory, and
    // allocating it may fail.
    const std::function<void(std::size_t, std::size_t)> reference = std::cref(answer);
    for_each_piece(count, thread_count, reference);
}

/// Sets each answer of a batch to answer_at(i), in pieces as by for_each_piece().
template <typename Answer, typename AnswerAt>
void answer_each(std::span<Answer> answers, unsigned thread_count, const AnswerAt& answer_at) noexcept {
    for_each_piece(answers.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) answers[i] = answer_at(i);
    });
}

/// Calls both functions, concurrently if two threads are available. Exceptions reach the caller.
void parallel_invoke(unsigned thread_count, const std::function<void()>& first,
                     const std::function<void()>& second);

} // namespace echinus

ECHINUS_EXPORT_END
