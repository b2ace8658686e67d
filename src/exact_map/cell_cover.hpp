#pragma once

#include "directions/octahedral_cells.hpp"

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// The part of a face that lies in a cell's cone, as a range of the L1 norm in lattice steps.
struct CellCover {
    std::uint32_t cell;
    std::uint16_t parts; ///< that the face touches, a bit each; of an edge-on face all
    double nearest, farthest;
};

/// Appends every cell whose closed cone the face touches. Cells are widened by far more than the rounding of
/// this code, so that none is missed; a cell too many costs a reference and no answer.
///
/// The face is clipped in space against the planes through the origin that bound octant, row, square and
/// triangle. On what is left, a flat polygon in one octant, the L1 norm is linear, so its extremes are at the
/// corners.
void cover_cells(const OctahedralCells& cells, const std::array<LatticePoint, 3>& face,
                 std::vector<CellCover>& covers);

} // namespace echinus
