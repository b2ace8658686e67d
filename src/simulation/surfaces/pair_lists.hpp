#pragma once

#include "simulation/state/state_archive.hpp"
#include "simulation/surfaces/separation.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// @param own_limit, opponent_limit  of the numbers of vertices
void archive(StateArchive& state, Pair& pair, std::size_t own_limit, std::size_t opponent_limit);

/// For each element of a deformable the pairs that it is in. The lists lie in one array; a list that has
/// grown out of its place moves to the end, and when half of the array is abandoned, all move together.
class PairLists {
  public:
    explicit PairLists(std::size_t element_count) : lists_(element_count) {}

    std::span<const Pair> of(std::size_t element) const {
        return {pairs_.data() + lists_[element].first, lists_[element].count};
    }
    void add(std::size_t element, const Pair& pair);
    void clear(std::size_t element) { lists_[element].count = 0; }

    /// @param own_count, opponent_count  of vertices
    void archive(StateArchive& state, std::size_t own_count, std::size_t opponent_count);

  private:
    struct List {
        std::size_t first = 0;
        std::uint32_t count = 0, capacity = 0;
    };

    void make_room(List& list);
    void move_together();

    std::vector<List> lists_;
    std::vector<Pair> pairs_, moved_;
    std::size_t abandoned_ = 0;
};

} // namespace echinus
