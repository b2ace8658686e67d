#pragma once

#include "mechanics/linear/block_matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// How the displacements of fine nodes follow from those of coarse ones: of each fine node the coarse nodes
/// that it follows and their weights.
struct Coarsening {
    Rows<float> parents;              ///< [fine node]; columns in no order
    std::vector<Vec3d> coarse_places; ///< at rest
    std::size_t coarse_count() const { return coarse_places.size(); }
};

/// Coarse nodes are fine ones, no two within two edges of each other, taken greedily in their order: of a
/// sheet of triangles about one in nine. A node follows the nearest four by edges, with the weights of moving
/// least squares (Lancaster and Salkauskas 1981), which keep what is linear in the place at rest. A row whose
/// node is held follows none. Parts of no more than four nodes stay as they are, unless most nodes are in
/// such parts: with fewer they could not turn.
/// @param graph   whose rows say which nodes are neighbours
/// @param places  [node] at rest
Coarsening coarsen(const Rows<Block>& graph, std::span<const Vec3d> places);

} // namespace echinus
