#pragma once

#include <echinus/exact_map_view.hpp>

#include <span>
#include <vector>

/// What an open surface's generalised winding number needs of a tree of triangles (Barill, Dickson, Schmidt,
/// Levin and Jacobson, "Fast Winding Numbers for Soups and Clouds", 2018), with bounds of what is left out.
///
/// The winding number around a place p is the sum over the faces of 1 / 4 pi times the integral of n (x - p)
/// / |x - p|^3. Seen from a distance r = |c - p| greater than the radius R of a group of faces around c, it
/// is expanded in powers of h = x - c. The term of order k is a derivative of order k + 1 of 1 / r, once
/// along n and k times along h, divided by k!. No such derivative exceeds (k + 1)! / r^(k+2), its value where
/// all directions are radial, so that no term exceeds
///
///     (k + 1) S_k / (4 pi r^(k+2)),  S_k = integral of |h|^k over the faces.
///
/// Terms of order 0 to 2 are summed: the dipole of all area vectors, and their first and second moments. As
/// S_k is at most S_2 R^(k-2), all others together are at most, with t = R / r,
///
///     S_2 / (4 pi r^4) (4 t + 5 t^2 + ...) = S_2 / (4 pi r^4) t (4 - 3 t) / (1 - t)^2.
namespace echinus {

/// The moments of a tree of triangles. Time O(nodes and triangles).
/// @param tree      its nodes and corners are set; children come after their parents
/// @param vertices  on the lattice
std::vector<WindingNode> find_winding_nodes(const WindingTree& tree,
                                            std::span<const Vec3<std::int32_t>> vertices);

} // namespace echinus
