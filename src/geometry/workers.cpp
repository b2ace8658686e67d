#include "geometry/workers.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>

#ifdef ECHINUS_WITH_TBB
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace echinus {

#ifdef ECHINUS_WITH_TBB

namespace {

using Body = std::function<void(std::size_t, std::size_t)>;

/// Lets a thread wait actively. It yields only after a long time: on a busy machine it might not run again
/// before the work is done.
class Patience {
  public:
    void wait() {
        pause();
        if (++turns_ % kTurnsAwake == 0) std::this_thread::yield();
    }

  private:
    static void pause() {
#if defined(__x86_64__) || defined(__i386__)
        __builtin_ia32_pause();
#endif
    }

    static constexpr unsigned kTurnsAwake = 1 << 14;
    unsigned turns_ = 0;
};

} // namespace

/// The pieces of a loop are claimed by a ticket: the number of the loop, and how many pieces were taken from
/// the front and from the back. Each worker takes pieces from one end, so that it mostly gets those that it
/// processed in the previous loop: memory written by another thread is slow to read. Before the description
/// of the loop is replaced, the ticket is closed, so that a thread that has read parts of both descriptions
/// cannot claim anything.
struct Workers::Team {
    static constexpr unsigned kBits = 20; ///< bits for the number of pieces taken from each end
    static constexpr std::uint64_t kMostPieces = (std::uint64_t{1} << kBits) - 1;
    static constexpr std::uint64_t kFromBack = std::uint64_t{1} << kBits;
    static constexpr std::uint64_t kNextLoop = kFromBack << kBits;
    static constexpr std::uint64_t kClosed = kNextLoop - 1; ///< the ticket of a closed loop

    explicit Team(int thread_count) : arena(thread_count) {}

    void work(std::size_t worker) {
        Patience patience;
        while (!is_over.load(std::memory_order_acquire))
            if (!take_one(worker) && !take_offer()) patience.wait();
    }

    bool take_offer() {
        if (!is_offered.load(std::memory_order_acquire)) return false;
        if (!is_offered.exchange(false, std::memory_order_acq_rel)) return false;
        offered();
        return true;
    }

    /// @return whether a piece was left
    bool take_one(std::size_t worker) {
        std::uint64_t now = ticket.load(std::memory_order_acquire);
        for (;;) {
            const std::size_t count = piece_count.load(std::memory_order_acquire);
            const Body* const what = body.load(std::memory_order_acquire);
            const std::uint64_t from_front = now & kMostPieces, from_back = now >> kBits & kMostPieces;
            if (from_front + from_back >= count) return false;
            const bool is_front = worker % 2 == 0;
            if (!ticket.compare_exchange_weak(now, now + (is_front ? 1 : kFromBack),
                                              std::memory_order_acq_rel, std::memory_order_acquire))
                continue;
            answer(*what, worker, is_front ? from_front : count - 1 - from_back);
            return true;
        }
    }

    void answer(const Body& what, std::size_t worker, std::size_t piece) {
        try {
            what(worker, piece);
        } catch (...) {
            if (!has_failed.exchange(true, std::memory_order_acq_rel)) failure = std::current_exception();
        }
        done.fetch_add(1, std::memory_order_acq_rel);
    }

    void run(std::size_t count, const Body& what) {
        const std::uint64_t next_loop = (ticket.load(std::memory_order_relaxed) | kClosed) + 1;
        ticket.store(next_loop | kClosed, std::memory_order_release);
        done.store(0, std::memory_order_release);
        body.store(&what, std::memory_order_release);
        piece_count.store(count, std::memory_order_release);
        ticket.store(next_loop, std::memory_order_release);
        while (take_one(0)) {
        }
        Patience patience;
        while (done.load(std::memory_order_acquire) != count) patience.wait();
        if (!has_failed.load(std::memory_order_acquire)) return;
        has_failed.store(false, std::memory_order_release);
        std::rethrow_exception(std::exchange(failure, nullptr));
    }

    tbb::task_arena arena;
    tbb::task_group group;
    std::atomic<bool> is_over = true;
    std::atomic<bool> is_offered = false;
    std::function<void()> offered;
    std::atomic<const Body*> body = nullptr;
    std::atomic<std::size_t> piece_count = 0;
    std::atomic<bool> has_failed = false;
    std::exception_ptr failure;
    alignas(64) std::atomic<std::uint64_t> ticket = kClosed;
    alignas(64) std::atomic<std::size_t> done = 0;
};

Workers::Workers(unsigned thread_count)
    : count_(worker_count(thread_count)), scratch_(std::make_unique<Scratch[]>(count_)) {
    if (count_ > 1) team_ = std::make_unique<Team>(static_cast<int>(count_));
}

void Workers::begin_session() const {
    if (!team_) return;
    team_->is_over.store(false, std::memory_order_release);
    team_->arena.execute([&] {
        for (std::size_t worker = 1; worker < count_; ++worker)
            team_->group.run([this, worker] { team_->work(worker); });
    });
}

void Workers::end_session() const noexcept {
    if (!team_) return;
    team_->is_offered.store(false, std::memory_order_release);
    team_->is_over.store(true, std::memory_order_release);
    team_->arena.execute([&] { team_->group.wait(); });
}

void Workers::offer(std::function<void()> task) const {
    if (!team_) return;
    team_->offered = std::move(task);
    team_->is_offered.store(true, std::memory_order_release);
}

void Workers::run(std::size_t piece_count, const Body& body) const {
    constexpr std::size_t kMost = Team::kMostPieces;
    for (std::size_t first = 0; first < piece_count; first += kMost)
        team_->run(std::min(kMost, piece_count - first),
                   [&](std::size_t worker, std::size_t piece) { body(worker, first + piece); });
}

#else

struct Workers::Team {};

Workers::Workers(unsigned) : count_(1), scratch_(std::make_unique<Scratch[]>(count_)) {}
void Workers::begin_session() const {}
void Workers::end_session() const noexcept {}
void Workers::offer(std::function<void()>) const {}
void Workers::run(std::size_t, const std::function<void(std::size_t, std::size_t)>&) const {}

#endif

Workers::~Workers() = default;

} // namespace echinus
