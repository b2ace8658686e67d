#pragma once

#include <atomic>
#include <cstddef>

namespace echinus {

/// What several threads have counted together, and whether it exceeds what is allowed. The final verdict does
/// not depend on which thread counted what.
class LimitedCount {
  public:
    explicit LimitedCount(std::size_t most) : most_(most) {}

    void add(std::size_t count) { total_.fetch_add(count, std::memory_order_relaxed); }
    bool exceeded() const { return total_.load(std::memory_order_relaxed) > most_; }

  private:
    std::size_t most_;
    std::atomic<std::size_t> total_ = 0;
};

/// One thread's share of a LimitedCount, handed in by large portions: threads seldom meet there.
class CountShare {
  public:
    explicit CountShare(LimitedCount& total) : total_(total) {}
    ~CountShare() { total_.add(mine_); }
    CountShare(const CountShare&) = delete;
    CountShare& operator=(const CountShare&) = delete;

    /// @returns  false when it is known that all threads together have counted too much
    bool add(std::size_t count) {
        constexpr std::size_t kPortion = 1U << 16;
        mine_ += count;
        if (mine_ < kPortion) return true;
        total_.add(mine_);
        mine_ = 0;
        return !total_.exceeded();
    }

  private:
    LimitedCount& total_;
    std::size_t mine_ = 0;
};

} // namespace echinus
