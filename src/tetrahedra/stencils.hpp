#pragma once

#include "tetrahedra/cut_points.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// A corner of a tetrahedron before vertices are numbered: a vertex of the lattice, or a cut point.
struct StencilCorner {
    static constexpr std::uint64_t kCutPoint = std::uint64_t{1} << 63U;

    std::uint64_t key; ///< the vertex's number, or the cut point's plus kCutPoint

    bool is_cut_point() const { return (key & kCutPoint) != 0; }
    std::uint64_t number() const { return key & ~kCutPoint; }
};
using StencilTetrahedron = std::array<StencilCorner, 4>;

/// Adds the part of a lattice tetrahedron that the surface leaves inside, by the stencils of Labelle and
/// Shewchuk 2007, figure 3: one to three tetrahedra, positive, where it has a corner inside; none otherwise.
/// Neighbours cut the quadrilateral on their common face along the same diagonal.
/// @param corners  as for_each_tetrahedron_at() gives them
void add_stencil(const BodyLattice& lattice, const LatticeSides& sides, const CutPoints& cuts,
                 const std::array<BodyLattice::Place, 4>& corners, std::vector<StencilTetrahedron>& result);

} // namespace echinus
