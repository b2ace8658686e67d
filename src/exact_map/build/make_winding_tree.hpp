#pragma once

#include <echinus/exact_map_view.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

/// The memory of ExactMapView::winding_tree, and what else queries of an open surface need.
struct OwnedWindingTree {
    std::vector<WindingNode> moments;
    std::vector<TreeNode> cap_nodes;        ///< none where the tree is that of the faces
    std::vector<std::uint32_t> cap_corners; ///< [3 cap_count]
    bool neighbours_disagree = false;       ///< as in ExactMapView

    void show_in(ExactMapView& map) const;
};

/// What a map's queries sum for the winding number of an open surface: caps of its border where they are far
/// fewer than its faces, or far shorter, else the faces. Time O(n log n) of the caps, O(n) of the faces.
/// @param map  its nodes, corners, vertices and border are set
OwnedWindingTree make_winding_tree(const ExactMapView& map);

} // namespace echinus
