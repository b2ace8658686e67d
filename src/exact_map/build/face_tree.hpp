#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A face as the tree sorts it. Items themselves are moved, so that comparisons need no look-up.
struct TreeItem {
    std::array<std::uint32_t, 3> place; ///< any measure of the position of the face
    std::uint32_t face;
};
static_assert(sizeof(TreeItem) == 16);

/// Puts the `left_count` items with the smallest places along the longest side of all places first. Ties are
/// broken by number, so that the choice is a function of the mesh alone. The order within each half is
/// arbitrary. Fastest if the items are nearly in this order already. Time O(n).
/// @pre 0 < left_count < items.size(); the faces differ
void split_at_longest_side(std::span<TreeItem> items, std::size_t left_count);

/// Sorts a few items by face number. Time O(n^2).
void sort_by_face(std::span<TreeItem> few);

struct FaceTree {
    std::vector<TreeNode> nodes;
    std::vector<std::uint32_t> order; ///< [face_count] the faces in the order of the leaves
};

/// Builds a tree of boxes over the faces of a lattice mesh, eight children wide, split at medians of the
/// centroids along the longest side. All nodes except the last of each level and all leaves except the last
/// are full. Time O(n log n).
/// @param tree  becomes the tree. If its order is that of another pose of the same mesh, fewer items have to
///              be moved; the result depends neither on that order nor on the number of threads.
/// @pre there is at least one face
void build_face_tree(const LatticeMesh& lattice, unsigned thread_count, FaceTree& tree);

} // namespace echinus
