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
/// @pre there is at least one face
FaceTree build_face_tree(const LatticeMesh& lattice);

} // namespace echinus
