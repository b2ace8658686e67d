#pragma once

#include "geometry/arena.hpp"

#include <echinus/exact_map.hpp>

#include <cstddef>
#include <cstdint>

namespace echinus {

/// The storage of an IndexArray. Keeps its memory between uses.
class IndexStorage {
  public:
    /// Of numbers that are all below `bound`.
    static constexpr std::size_t bytes_per_number(std::size_t bound) { return bound <= 65536 ? 2 : 4; }

    /// Makes room for so many numbers, all below `bound`; what they are is arbitrary until set.
    void reset(std::size_t size, std::size_t bound) {
        const bool narrow = bytes_per_number(bound) == 2;
        narrow_.reset(narrow ? size : 0);
        wide_.reset(narrow ? 0 : size);
        is_narrow_ = narrow;
    }

    /// Calls visit(pointer to the numbers), of the type that they are stored in.
    template <typename Visit>
    void with_numbers(const Visit& visit) {
        if (is_narrow_)
            visit(narrow_.data());
        else
            visit(wide_.data());
    }

    std::size_t size() const { return narrow_.size() + wide_.size(); }
    IndexArray view() const { return {narrow_, wide_}; }

  private:
    Arena<std::uint16_t> narrow_;
    Arena<std::uint32_t> wide_;
    bool is_narrow_ = true;
};

} // namespace echinus
