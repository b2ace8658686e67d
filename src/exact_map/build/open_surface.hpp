#pragma once

#include "directions/lattice.hpp"
#include "exact_map/layout.hpp"

#include <echinus/exact_map.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/mesh.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

// The border of an open surface; exact_map/query/winding.cpp explains its use.

/// The edges along which different numbers of faces run in the two directions, ascending. Vertices on one
/// lattice point count as one. Empty when the surface is closed, as it surely is where is_closed()
/// finds it so: that takes less time, and what collapses on the lattice has no border there.
std::vector<BorderEdge> find_border(const LatticeMesh& lattice);

/// Triangles that close an open surface: with its faces, equally many triangles run along every edge in both
/// directions. The border is taken apart into loops, and each loop is halved again and again, so that most
/// triangles are as short as the border's edges. Those without area are left out. Time O(n log n).
/// @param border    of whole loops, as find_border() finds it; what leads nowhere is left open
/// @param vertices  on the lattice
std::vector<Triangle> cap_border(std::span<const BorderEdge> border,
                                 std::span<const Vec3<std::int32_t>> vertices);

// The data of a tree of triangles for the generalised winding number of an open surface (Barill, Dickson,
// Schmidt, Levin and Jacobson, "Fast Winding Numbers for Soups and Clouds", 2018), with bounds of the
// neglected terms.
//
// The winding number around a place p is the sum over the faces of 1 / 4 pi times the integral of n (x - p)
// / |x - p|^3. Seen from a distance r = |c - p| greater than the radius R of a group of faces around c, it
// is expanded in powers of h = x - c. The term of order k is a derivative of order k + 1 of 1 / r, once
// along n and k times along h, divided by k!. No such derivative exceeds (k + 1)! / r^(k+2), its value where
// all directions are radial, so that no term exceeds
//
//     (k + 1) S_k / (4 pi r^(k+2)),  S_k = integral of |h|^k over the faces.
//
// Terms of order 0 to 2 are summed: the dipole of all area vectors, and their first and second moments. As
// S_k is at most S_2 R^(k-2), all others together are at most, with t = R / r,
//
//     S_2 / (4 pi r^4) (4 t + 5 t^2 + ...) = S_2 / (4 pi r^4) t (4 - 3 t) / (1 - t)^2.

/// The moments of a tree of triangles. Time O(nodes and triangles).
/// @param tree      its nodes and corners are set; children come after their parents
/// @param vertices  on the lattice
std::vector<WindingNode> find_winding_nodes(const WindingTree& tree,
                                            std::span<const Vec3<std::int32_t>> vertices);

/// A winding tree and its memory, which moves with it.
struct OwnedWindingTree {
    OwnedWindingTree() = default;
    OwnedWindingTree(const OwnedWindingTree&) = delete;
    OwnedWindingTree& operator=(const OwnedWindingTree&) = delete;
    OwnedWindingTree(OwnedWindingTree&&) noexcept = default;
    OwnedWindingTree& operator=(OwnedWindingTree&&) noexcept = default;
    ~OwnedWindingTree() = default;

    std::vector<WindingNode> moments;
    std::vector<TreeNode> cap_nodes;        ///< none where the tree is that of the faces
    std::vector<std::uint32_t> cap_corners; ///< [3 cap_count]
    WindingTree tree;                       ///< of these arrays, and of the map's
};

/// Makes the tree of triangles over which queries of an open surface sum: caps of its border if they are far
/// fewer or far shorter than its faces, otherwise the faces. The time is O(n log n) for caps and O(n) for
/// faces.
/// @param map  its nodes, corners, vertices and border are set
OwnedWindingTree make_winding_tree(const ExactMapView& map);

} // namespace echinus
