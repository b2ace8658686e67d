#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

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
