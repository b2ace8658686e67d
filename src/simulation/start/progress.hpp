#pragma once

#include <cstddef>
#include <limits>

namespace echinus {

/// Whether rounds of separating intersecting elements still make progress.
class Progress {
  public:
    /// @param patience  the number of successive rounds that need not improve on the best round before
    explicit Progress(int patience) : patience_(patience) {}

    /// @return false once that many rounds have made no progress, or the state has become far worse
    bool goes_on(std::size_t left) {
        idle_rounds_ = left < least_ ? 0 : idle_rounds_ + 1;
        if (left < least_) least_ = left;
        return idle_rounds_ < patience_ && left / kFarWorse <= least_ + kFew;
    }

    /// The last round has made no progress.
    bool is_idle() const { return idle_rounds_ > 0; }

  private:
    static constexpr std::size_t kFarWorse = 4, kFew = 64;

    int patience_, idle_rounds_ = 0;
    std::size_t least_ = std::numeric_limits<std::size_t>::max();
};

} // namespace echinus
