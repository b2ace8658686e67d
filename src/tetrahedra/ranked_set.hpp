#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// A set of numbers below a limit, which also tells how many of its members are smaller than one: one and a
/// half bits for each number of the range.
class RankedSet {
  public:
    explicit RankedSet(std::size_t limit) : words_(limit / 64 + 1), ranks_(words_.size()) {}

    void insert(std::uint64_t number) { words_[number / 64] |= bit(number); }

    /// To be called after the last insert().
    /// @returns how many members there are. @pre fewer than 2^32
    std::uint32_t count_ranks() {
        std::uint32_t count = 0;
        for (std::size_t i = 0; i < words_.size(); ++i) {
            ranks_[i] = count;
            count += static_cast<std::uint32_t>(std::popcount(words_[i]));
        }
        return count;
    }

    std::uint32_t rank(std::uint64_t number) const {
        const std::uint64_t below = words_[number / 64] & (bit(number) - 1);
        return ranks_[number / 64] + static_cast<std::uint32_t>(std::popcount(below));
    }

    /// Calls visit(number) for each member, ascending.
    template <typename Visit>
    void for_each(Visit&& visit) const {
        for (std::size_t i = 0; i < words_.size(); ++i)
            for (std::uint64_t rest = words_[i]; rest != 0; rest &= rest - 1)
                visit(64 * i + static_cast<std::uint64_t>(std::countr_zero(rest)));
    }

  private:
    static std::uint64_t bit(std::uint64_t number) { return std::uint64_t{1} << number % 64; }

    std::vector<std::uint64_t> words_;
    std::vector<std::uint32_t> ranks_; ///< of the first number of each word
};

} // namespace echinus
