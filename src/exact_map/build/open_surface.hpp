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

/// The edges along which different numbers of faces run in the two directions, ascending. Vertices at the
/// same lattice point count as one. Empty if the surface is closed. is_closed() is a faster test that
/// suffices: if it returns true, the border is empty, since faces that collapse on the lattice contribute no
/// border edges.
std::vector<BorderEdge> find_border(const LatticeMesh& lattice);

/// Triangles that close an open surface: together with its faces, equally many triangles run along every edge
/// in both directions. The border is decomposed into loops, and each loop is halved recursively, so that most
/// triangles are as short as the border's edges. Triangles without area are omitted. Time O(n log n).
/// @param border    consists of whole loops, as find_border() returns it; edges that are part of no loop are
///                left open
/// @param vertices  lattice points
std::vector<Triangle> cap_border(std::span<const BorderEdge> border,
                                 std::span<const Vec3<std::int32_t>> vertices);

// A tree of triangles for the generalised winding number of an open surface (Barill, Dickson, Schmidt, Levin
// and Jacobson, "Fast Winding Numbers for Soups and Clouds", 2018), with bounds for the neglected terms.
//
// The winding number around a point p is the sum over the faces of 1 / 4 pi times the integral of n (x - p) /
// |x - p|^3. Seen from a distance r = |c - p| greater than the radius R of a group of faces around c, it is
// expanded in powers of h = x - c. The term of order k is a derivative of 1 / r of order k + 1, once along n
// and k times along h, divided by k!. No such derivative exceeds (k + 1)! / r^(k+2), its value if all
// directions are radial, so no term exceeds
//
//     (k + 1) S_k / (4 pi r^(k+2)),  S_k = integral of |h|^k over the faces.
//
// The terms of orders 0 to 2 are summed: the dipole of all area vectors, and their first and second moments.
// Since S_k is at most S_2 R^(k-2), the sum of all others is at most, with t = R / r,
//
//     S_2 / (4 pi r^4) (4 t + 5 t^2 + ...) = S_2 / (4 pi r^4) t (4 - 3 t) / (1 - t)^2.

/// The moments of a tree of triangles. Time O(nodes and triangles).
/// @param tree      has nodes and corners; children come after their parents
/// @param vertices  lattice points
std::vector<WindingNode> find_winding_nodes(const WindingTree& tree,
                                            std::span<const Vec3<std::int32_t>> vertices);

/// A winding tree and the memory that it refers to, which moves with it.
struct OwnedWindingTree {
    OwnedWindingTree() = default;
    OwnedWindingTree(const OwnedWindingTree&) = delete;
    OwnedWindingTree& operator=(const OwnedWindingTree&) = delete;
    OwnedWindingTree(OwnedWindingTree&&) noexcept = default;
    OwnedWindingTree& operator=(OwnedWindingTree&&) noexcept = default;
    ~OwnedWindingTree() = default;

    std::vector<WindingNode> moments;
    std::vector<TreeNode> cap_nodes;        ///< empty if the tree is that of the faces
    std::vector<std::uint32_t> cap_corners; ///< [3 cap_count]
    WindingTree tree;                       ///< refers to these arrays and to the map's
};

/// Makes the tree of triangles over which queries of an open surface sum: caps of its border if they are far
/// fewer or far shorter than its faces, otherwise the faces. Time O(n log n) for caps, O(n) for faces.
/// @param map  has nodes, corners, vertices and border
OwnedWindingTree make_winding_tree(const ExactMapView& map);

} // namespace echinus
