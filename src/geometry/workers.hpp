#pragma once

#include "geometry/scratch.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace echinus {

/// Threads that share the work of many short loops, one loop after the other.
///
/// Work is cut into pieces by its size, never by the number of threads. Where a loop gathers results, it does
/// so piece by piece, in their order: then the threads do not decide any bits.
///
/// Loops are shared while a session lasts. In it, threads that have nothing to do wait awake for the next
/// loop, since to wake one takes longer than many loops do. They are oneTBB's; one that has not come yet is
/// not waited for.
class Workers {
  public:
    /// @param thread_count  0: all cores. Without oneTBB there is one
    explicit Workers(unsigned thread_count = 1);
    /// As many of its own, without a session.
    Workers(const Workers& other) : Workers(static_cast<unsigned>(other.count_)) {}
    Workers& operator=(const Workers&) = delete;
    ~Workers();

    std::size_t count() const { return count_; }
    /// Of a worker, for the piece that it has taken; the first one's is for the caller between loops, too.
    Scratch& scratch(std::size_t worker = 0) const { return scratch_[worker]; }

    /// While it lives, loops are shared. One at a time.
    class Session {
      public:
        explicit Session(const Workers& workers) : workers_(workers) { workers_.begin_session(); }
        Session(const Session&) = delete;
        Session& operator=(const Session&) = delete;
        ~Session() { workers_.end_session(); }

      private:
        const Workers& workers_;
    };

    /// In a session: a thread that finds no piece to take calls task() once. Nobody does if none comes free
    /// before the session ends, or if there is but one. The session's end waits for it.
    /// @pre the task throws nothing, starts no loop here, and the last one is done or its session over
    void offer(std::function<void()> task) const;

    /// Calls body(worker, piece) for each piece below piece_count, in any order, with worker < count(). No
    /// two calls with the same worker overlap in time, so each can have its own memory. Exceptions reach the
    /// caller. A single worker allocates nothing, and takes the pieces in order.
    /// @pre the body starts no loop itself
    template <typename Body>
    void for_pieces(std::size_t piece_count, const Body& body) const {
        if (count_ == 1 || piece_count < 2) {
            for (std::size_t piece = 0; piece < piece_count; ++piece) body(std::size_t{0}, piece);
            return;
        }
        run(piece_count, std::cref(body));
    }
    /// Calls body(worker, piece, begin, end) for ranges of piece_size, the last of which may be shorter, that
    /// together cover [0, count).
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
    std::unique_ptr<Team> team_;         ///< none for a single worker
};

/// A list to which the pieces of a parallel loop append, in the order of the pieces.
template <typename T>
class PiecewiseList {
  public:
    void begin(const Workers& workers, std::size_t piece_count) {
        by_worker_.resize(workers.count());
        for (Part& part : by_worker_) part.items.clear();
        slices_.resize(piece_count);
    }
    /// Calls append(items) with a vector to append to. Once for each piece.
    template <typename Append>
    void add(std::size_t worker, std::size_t piece, const Append& append) {
        std::vector<T>& items = by_worker_[worker].items;
        const std::size_t first = items.size();
        append(items);
        slices_[piece] = {worker, first, items.size()};
    }
    /// Calls visit(item) for all, in order.
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
    /// On cache lines of its own.
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
