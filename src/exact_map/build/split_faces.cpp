#include "exact_map/build/split_faces.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <utility>

namespace echinus {

namespace {

using Places = std::array<std::uint32_t, 3>;

struct Box {
    Places low, high;
};

Box box_of(std::span<const TreeItem> items) {
    Box box{items[0].place, items[0].place};
    for (const TreeItem& item : items)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], item.place[axis]);
            box.high[axis] = std::max(box.high[axis], item.place[axis]);
        }
    return box;
}

/// Orders items by their place along one axis, ties by number.
class KeyAlong {
  public:
    explicit KeyAlong(std::size_t axis) : axis_(axis) {}
    std::uint64_t operator()(const TreeItem& item) const { return packed<32>(item.place[axis_], item.face); }

  private:
    std::size_t axis_;
};

/// Puts items whose keys are below the limit first, and returns how many there are. Every item is swapped,
/// and what remains is decided by how far a position moves on: nothing for a processor to mispredict.
template <typename Key>
std::size_t partition_below(std::span<TreeItem> items, std::uint64_t limit, const Key& key) {
    std::size_t below = 0;
    for (TreeItem& item : items) {
        const TreeItem moved = item;
        item = items[below];
        items[below] = moved;
        below += key(moved) < limit ? 1 : 0;
    }
    return below;
}

/// Sorts by counting how many keys come before each: all pairs are compared, without a branch.
template <std::size_t kMost, typename Key>
void sort_few(std::span<TreeItem> items, const Key& key) {
    std::array<std::uint64_t, kMost> keys;
    std::array<std::uint32_t, kMost> rank;
    std::array<TreeItem, kMost> copy;
    for (std::size_t i = 0; i < items.size(); ++i) {
        copy[i] = items[i];
        keys[i] = key(items[i]);
        std::uint32_t smaller = 0;
        for (std::size_t k = 0; k < i; ++k) {
            const std::uint32_t is_smaller = keys[k] < keys[i] ? 1 : 0;
            smaller += is_smaller;
            rank[k] += 1 - is_smaller;
        }
        rank[i] = smaller;
    }
    const std::size_t count = items.size();
    for (std::size_t i = 0; i < count; ++i) items[rank[i]] = copy[i];
}

/// A key that about `left_count` items are below, from a sample; on the side of the middle, so that the next
/// search has less to look at.
template <typename Key>
std::uint64_t estimated_limit(std::span<const TreeItem> items, std::size_t left_count, const Key& key) {
    constexpr std::size_t kLargestSample = 64;
    std::array<std::uint64_t, kLargestSample> sample;
    const std::size_t size = items.size() >= 2048 ? kLargestSample : items.size() >= 256 ? 24 : 8;
    for (std::size_t i = 0; i < size; ++i) sample[i] = key(items[i * items.size() / size]);
    std::sort(sample.begin(), sample.begin() + size);
    const std::size_t wanted = left_count * size / items.size();
    // Beyond the wanted one by about what a sample errs, away from the nearer end.
    const std::size_t margin = size >= 24 ? size / 12 : 1;
    const std::size_t chosen = 2 * left_count <= items.size() ? std::min(wanted + margin, size - 1)
                                                              : wanted - std::min(margin, wanted);
    return sample[chosen];
}

/// Puts the `left_count` smallest first (Hoare's selection, with limits from samples as Floyd and Rivest
/// 1975).
template <typename Key>
void select(std::span<TreeItem> items, std::size_t left_count, const Key& key) {
    constexpr std::size_t kFew = 24;
    while (left_count > 0 && left_count < items.size()) {
        if (items.size() <= kFew) return sort_few<kFew>(items, key);
        std::uint64_t limit = estimated_limit(items, left_count, key);
        std::size_t below = partition_below(items, limit, key);
        if (below == 0) below = partition_below(items, limit + 1, key); // the limit was the least of all
        if (below <= left_count) {
            items = items.subspan(below);
            left_count -= below;
        } else {
            items = items.first(below);
        }
    }
}

} // namespace

void split_at_longest_side(std::span<TreeItem> items, std::size_t left_count) {
    const std::span<TreeItem> left = items.first(left_count), right = items.subspan(left_count);
    const Box left_box = box_of(left), right_box = box_of(right);
    const auto low = [&](std::size_t axis) { return std::min(left_box.low[axis], right_box.low[axis]); };
    const auto side = [&](std::size_t axis) {
        return std::max(left_box.high[axis], right_box.high[axis]) - low(axis);
    };
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other)
        if (side(other) > side(axis)) axis = other;

    const std::uint32_t overlap_low = right_box.low[axis], overlap_high = left_box.high[axis];
    if (overlap_high < overlap_low) return; // they lie as they should
    const KeyAlong key(axis);
    if (overlap_high - overlap_low > side(axis) / 4) return select(items, left_count, key);
    // Items to the left of all items of the right half stay there, and likewise on the other side.
    const std::size_t left_sure = partition_below(left, packed<32>(overlap_low, 0), key);
    const std::size_t right_unsure = partition_below(right, packed<32>(overlap_high + 1, 0), key);
    select(items.subspan(left_sure, left_count - left_sure + right_unsure), left_count - left_sure, key);
}

void sort_by_face(std::span<TreeItem> few) {
    constexpr std::size_t kFew = 8;
    if (few.size() <= kFew)
        return sort_few<kFew>(few, [](const TreeItem& item) { return std::uint64_t{item.face}; });
    std::sort(few.begin(), few.end(), [](const TreeItem& a, const TreeItem& b) { return a.face < b.face; });
}

} // namespace echinus
