#pragma once

#include "geometry/scratch.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace echinus {

/// Threads that share the work of many short loops, one after the other.
///
/// Work is cut into pieces according to its size, never to the number of threads. A loop that gathers results
/// does so piece by piece, in their order, so that the result does not depend on the threads.
///
/// Loops are shared during a session. Idle threads then wait actively for the next loop, since waking a
/// thread takes longer than many loops do. The threads are oneTBB's; a loop does not wait for threads that
/// have not started yet.
class Workers {
  public:
    /// @param thread_count  0: all cores. Without oneTBB there is only one thread
    explicit Workers(unsigned thread_count = 1);
    /// The copy has as many threads of its own, and no session.
    Workers(const Workers& other) : Workers(static_cast<unsigned>(other.count_)) {}
    Workers& operator=(const Workers&) = delete;
    ~Workers();

    std::size_t count() const { return count_; }
    /// The memory of a worker for the piece that it has taken. Between loops, the caller may use the first
    /// worker's.
    Scratch& scratch(std::size_t worker = 0) const { return scratch_[worker]; }

    /// Loops are shared while a Session exists. There may be one at a time.
    class Session {
      public:
        explicit Session(const Workers& workers) : workers_(workers) { workers_.begin_session(); }
        Session(const Session&) = delete;
        Session& operator=(const Session&) = delete;
        ~Session() { workers_.end_session(); }

      private:
        const Workers& workers_;
    };

    /// In a session, the first thread that finds no piece to take calls task() once. The task is not called
    /// if no thread becomes idle before the session ends, or if there is only one thread. The end of the
    /// session waits for a running task.
    /// @pre the task throws nothing and starts no loop of these workers; the previous task is done, or its
    /// session has ended
    void offer(std::function<void()> task) const;

    /// Calls body(worker, piece) for each piece below piece_count, in any order, with worker < count(). No
    /// two calls with the same worker overlap in time, so each worker can have its own memory. Exceptions
    /// reach the caller. A single worker allocates nothing and takes the pieces in order.
    /// @pre the body starts no loop itself
    template <typename Body>
    void for_pieces(std::size_t piece_count, const Body& body) const {
        if (count_ == 1 || piece_count < 2) {
            for (std::size_t piece = 0; piece < piece_count; ++piece) body(std::size_t{0}, piece);
            return;
        }
        run(piece_count, std::cref(body));
    }
    /// Calls body(worker, piece, begin, end) for ranges that together cover [0, count). Each has length
    /// piece_size, except that the last may be shorter.
    template <typename Body>
    void for_ranges(std::size_t count, std::size_t piece_size, const Body& body) const {
        for_pieces(piece_count(count, piece_size), [&](std::size_t worker, std::size_t piece) {
            const std::size_t begin = piece * piece_size;
            body(worker, piece, begin, count - begin < piece_size ? count : begin + piece_size);
        });
    }
    static std::size_t piece_count(std::size_t count, std::size_t piece_size) {
        return (count + piece_size - 1) / piece_size;
    }

  private:
    struct Team;

    void begin_session() const;
    void end_session() const noexcept;
    void run(std::size_t piece_count, const std::function<void(std::size_t, std::size_t)>& body) const;

    std::size_t count_;
    std::unique_ptr<Scratch[]> scratch_; ///< [worker]
    std::unique_ptr<Team> team_;         ///< null for a single worker
};

/// A list to which the pieces of a parallel loop append; its items are in the order of the pieces.
template <typename T>
class PiecewiseList {
  public:
    void begin(const Workers& workers, std::size_t piece_count) {
        by_worker_.resize(workers.count());
        for (Part& part : by_worker_) part.items.clear();
        slices_.resize(piece_count);
    }
    /// Calls append(items) with a vector to append to. Must be called once for each piece.
    template <typename Append>
    void add(std::size_t worker, std::size_t piece, const Append& append) {
        std::vector<T>& items = by_worker_[worker].items;
        const std::size_t first = items.size();
        append(items);
        slices_[piece] = {worker, first, items.size()};
    }
    /// Calls visit(item) for all items, in order.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (const Slice& slice : slices_)
            for (std::size_t i = slice.first; i < slice.end; ++i) visit(by_worker_[slice.worker].items[i]);
    }
    void append_to(std::vector<T>& all) const {
        for (const Slice& slice : slices_) {
            const auto begin = by_worker_[slice.worker].items.begin();
            all.insert(all.end(), begin + static_cast<std::ptrdiff_t>(slice.first),
                       begin + static_cast<std::ptrdiff_t>(slice.end));
        }
    }

  private:
    /// Occupies separate cache lines.
    struct alignas(64) Part {
        std::vector<T> items;
    };
    struct Slice {
        std::size_t worker = 0, first = 0, end = 0;
    };

    std::vector<Part> by_worker_;
    std::vector<Slice> slices_;
};

} // namespace echinus
