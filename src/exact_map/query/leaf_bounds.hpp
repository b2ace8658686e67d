#pragma once

#include "exact_map/query/nearest.hpp"
#include "geometry/triangle.hpp"

#include <array>

namespace echinus {

/// A triangle in single precision, relative to a lattice point at one of its corners.
struct NearTriangle {
    Vec3<std::int32_t> origin;
    std::array<Vec3f, 3> corners; ///< relative to the origin
    Vec3f low, high;              ///< limits of the box around it, relative to the origin; rounded outwards

    /// The distance from the map's centre, in lattice steps, up to which single precision represents all
    /// differences of lattice points exactly.
    static constexpr double kRange = 0x1p23;
};

/// Distances of a triangle from the faces of a leaf, in lattice steps.
struct LeafBounds {
    alignas(64) std::array<float, TreeNode::kWidth> lower, upper;
};

/// Bounds the distances by vector instructions, so that most pairs are decided without distance_from_below().
/// How tight the bounds are depends on the instruction set; that they hold does not.
/// @param reach_sq  if no face has a box within this squared distance, all lower bounds are infinite and
///                  nothing else is computed
/// @return whether the box of any face is within `reach_sq`
bool bound_leaf_distances(const ExactMapView& map, const LeafFaces& faces, const NearTriangle& triangle,
                          float reach_sq, LeafBounds& bounds) noexcept;

} // namespace echinus
