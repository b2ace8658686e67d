#pragma once

#include "exact_map/query/nearest.hpp"
#include "geometry/triangle.hpp"

#include <array>

namespace echinus {

/// A triangle in single precision, around a lattice point at one of its corners.
struct NearTriangle {
    Vec3<std::int32_t> origin;
    std::array<Vec3f, 3> corners; ///< from the origin
    Vec3f low, high;              ///< of the box around it, from the origin; rounded outwards

    /// Lattice steps from the map's centre: up to there single precision holds all differences of lattice
    /// points.
    static constexpr double kRange = 0x1p23;
};

/// Distances of a triangle from the faces of a leaf, in lattice steps.
struct LeafBounds {
    alignas(64) std::array<float, TreeNode::kWidth> lower, upper;
};

/// Bounds of the distances by vector instructions: to decide most pairs without distance_from_below(). How
/// near to each other they are depends on the instruction set; that they are bounds does not.
/// @param reach_sq  where no face has a box within it, all lower bounds are infinite and nothing more is
/// computed
/// @return whether a face has
bool bound_leaf_distances(const ExactMapView& map, const LeafFaces& faces, const NearTriangle& triangle,
                          float reach_sq, LeafBounds& bounds) noexcept;

} // namespace echinus
