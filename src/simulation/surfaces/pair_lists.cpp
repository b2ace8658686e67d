#include "simulation/surfaces/pair_lists.hpp"

#include <algorithm>

namespace echinus {

namespace {

constexpr std::uint32_t kLeastCapacity = 8;
/// Fewer abandoned places are not worth moving.
constexpr std::size_t kFewAbandoned = 4096;

} // namespace

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
