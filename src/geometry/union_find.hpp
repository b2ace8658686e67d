#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace echinus {

/// Disjoint sets of 0 .. size - 1. The representative of a set is its smallest member, whatever the order of
/// the joins.
class UnionFind {
  public:
    explicit UnionFind(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0U); }

    std::uint32_t find(std::uint32_t member) {
        while (parent_[member] != member) {
            parent_[member] = parent_[parent_[member]]; // halves the path for the next search
            member = parent_[member];
        }
        return member;
    }

    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (b < a) std::swap(a, b);
        parent_[b] = a;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

} // namespace echinus
