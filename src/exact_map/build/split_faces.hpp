#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace echinus {

/// A face as a tree sorts it: these are moved about, so that comparisons need no look-up.
struct TreeItem {
    std::array<std::uint32_t, 3> place; ///< any measure of where the face is
    std::uint32_t face;
};
static_assert(sizeof(TreeItem) == 16);

/// Puts the `left_count` items with the smallest places along the longest side of all places first; ties by
/// number, so that which faces these are is a function of the mesh alone. The order on either side is
/// arbitrary. Fastest when the items are nearly so already. Time O(n).
/// @pre 0 < left_count < items.size(); the faces differ
void split_at_longest_side(std::span<TreeItem> items, std::size_t left_count);

/// Sorts a few items by number. Time O(n^2).
void sort_by_face(std::span<TreeItem> few);

} // namespace echinus
