#pragma once

#include <cstddef>
#include <limits>

namespace echinus {

/// Whether rounds that part what intersects still get anywhere.
class Progress {
  public:
    /// @param patience  rounds in a row that may leave as much as the best one before
    explicit Progress(int patience) : patience_(patience) {}

    /// @return false once that many rounds have brought nothing, or it has become far worse
    bool goes_on(std::size_t left) {
        idle_rounds_ = left < least_ ? 0 : idle_rounds_ + 1;
        if (left < least_) least_ = left;
        return idle_rounds_ < patience_ && left / kFarWorse <= least_ + kFew;
    }

    /// The last round has brought nothing.
    bool is_idle() const { return idle_rounds_ > 0; }

  private:
    static constexpr std::size_t kFarWorse = 4, kFew = 64;

    int patience_, idle_rounds_ = 0;
    std::size_t least_ = std::numeric_limits<std::size_t>::max();
};

} // namespace echinus
