#pragma once

#include "mechanics/linear/block_matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How the displacements of fine nodes follow from those of coarse nodes: the coarse nodes that each fine
/// node follows, and their weights.
struct Coarsening {
    Rows<float> parents;              ///< [fine node]; columns in any order
    std::vector<Vec3d> coarse_places; ///< at rest
    std::size_t coarse_count() const { return coarse_places.size(); }
};

/// Coarse nodes are fine nodes, no two within two edges of each other, chosen greedily in their order; in a
/// sheet of triangles about one in nine. A node follows the nearest four within a number of edges, with the
/// weights of moving least squares (Lancaster and Salkauskas 1981), which reproduce linear functions of the
/// rest position. Components of no more than four nodes keep all nodes, unless most nodes are in such
/// components: with fewer they could not rotate.
/// @param graph   its rows contain the neighbours of each node
/// @param places  [node] at rest
Coarsening coarsen(const Rows<Block>& graph, std::span<const Vec3d> places);

} // namespace echinus
