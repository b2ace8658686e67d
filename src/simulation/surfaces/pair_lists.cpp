#include "simulation/surfaces/pair_lists.hpp"

#include <algorithm>

namespace echinus {

namespace {

constexpr std::uint32_t kLeastCapacity = 8;
/// Fewer abandoned places are not worth moving.
constexpr std::size_t kFewAbandoned = 4096;

} // namespace

void archive(StateArchive& state, Pair& pair, std::size_t own_limit, std::size_t opponent_limit) {
    state.choice(pair.kind, PairKind::EdgeEdge);
    for (std::size_t k = 0; k < 4; ++k)
        state.index(pair.points[k], k < own_count(pair.kind) ? own_limit : opponent_limit);
}

/// Where the lists lie does not matter.
void PairLists::archive(StateArchive& state, std::size_t own_count, std::size_t opponent_count) {
    if (state.reads()) *this = PairLists(lists_.size());
    std::vector<Pair> pairs;
    for (std::size_t e = 0; e < lists_.size(); ++e) {
        pairs.assign(of(e).begin(), of(e).end());
        state.items(pairs, [&](Pair& pair) { echinus::archive(state, pair, own_count, opponent_count); });
        if (!state.reads()) continue;
        for (const Pair& pair : pairs) add(e, pair);
    }
}

void PairLists::add(std::size_t element, const Pair& pair) {
    List& list = lists_[element];
    if (list.count == list.capacity) make_room(list);
    pairs_[list.first + list.count++] = pair;
}

void PairLists::make_room(List& list) {
    abandoned_ += list.capacity;
    list.capacity = std::max(kLeastCapacity, 2 * list.capacity);
    const std::size_t first = pairs_.size();
    pairs_.resize(first + list.capacity);
    std::copy_n(pairs_.begin() + static_cast<std::ptrdiff_t>(list.first), list.count,
                pairs_.begin() + static_cast<std::ptrdiff_t>(first));
    list.first = first;
    if (abandoned_ > kFewAbandoned && 2 * abandoned_ > pairs_.size()) move_together();
}

void PairLists::move_together() {
    moved_.clear();
    for (List& list : lists_) {
        const std::size_t first = moved_.size();
        moved_.resize(first + list.capacity);
        std::copy_n(pairs_.begin() + static_cast<std::ptrdiff_t>(list.first), list.count,
                    moved_.begin() + static_cast<std::ptrdiff_t>(first));
        list.first = first;
    }
    pairs_.swap(moved_);
    abandoned_ = 0;
}

} // namespace echinus
