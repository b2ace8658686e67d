#pragma once

#include "support/portable_random.hpp"

#include <cstddef>
#include <cstdint>

namespace echinus::test {

/// Decisions of a seed: the same on every machine.
class Choices {
  public:
    explicit Choices(std::uint64_t seed) : random_(seed) {}

    /// A whole number from `low` to `high`, both included.
    int between(int low, int high) { return low + static_cast<int>(random_.uniform() * (high - low + 1)); }
    std::size_t below(std::size_t count) {
        return static_cast<std::size_t>(random_.uniform() * static_cast<double>(count));
    }
    bool chance(double probability) { return random_.uniform() < probability; }
    double within(double low, double high) { return random_.uniform(low, high); }
    template <typename List>
    const auto& one_of(const List& list) {
        return list[below(std::size(list))];
    }

  private:
    test::PortableRandom random_;
};

} // namespace echinus::test
