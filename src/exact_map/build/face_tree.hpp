#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

struct FaceTree {
    std::vector<TreeNode> nodes;
    std::vector<std::uint32_t> order; ///< [face_count] faces as the leaves want them
};

/// A tree of boxes over the faces of a lattice mesh, eight wide, split at medians of the centroids along the
/// longest side. All nodes but the last of each level and all leaves but the last are full. Time O(n log n).
/// @param tree  becomes the tree. If its order is that of another moment of the same mesh, less has to be
///              moved; the result does not depend on that, nor on the number of threads.
/// @pre there is at least one face
void build_face_tree(const LatticeMesh& lattice, unsigned thread_count, FaceTree& tree);

} // namespace echinus
