#pragma once

#include "directions/octahedral_cells.hpp"

#include <echinus/geometry.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace echinus {

/// Whether a face meets the ray through a cell's middle.
enum class MiddleRay : std::uint8_t {
    Misses,
    Meets,  ///< the ray lies within the face's directions; meaningless for a face seen edge-on
    Unsure, ///< rounding might decide
};

/// Where a face passes through the cone of a cell.
struct CellCover {
    std::uint32_t cell;
    std::uint16_t parts; ///< parts of the cell that the face touches, one bit each
    MiddleRay middle;
    double nearest, farthest; ///< range of the L1 norm, in lattice steps
};

/// Neighbouring octants of OctahedralCells, whose cells are numbered without a gap.
struct Octants {
    std::uint32_t first = 0, last = 8; ///< half open

    std::uint32_t count() const { return last - first; }
    bool hold(std::uint32_t octant) const { return octant >= first && octant < last; }
    /// One bit for each octant, as in octants_met().
    std::uint32_t bits() const { return (1U << last) - (1U << first); }
};

/// The octants that a face may touch, one bit each.
std::uint32_t octants_met(const std::array<LatticePoint, 3>& face);

/// Appends every cell of these octants whose closed cone the face touches. Cells, parts and ranges are wider
/// than the face by far more than the rounding errors, so that none is missed; a superfluous one costs a
/// reference but changes no answer.
///
/// The face is cut at the octants' walls. In an octant its directions are a convex polygon in the plane x + y
/// + z = 1, and a cell or part is touched unless one of its sides or of the polygon's separates them (the
/// separating axis theorem). So the polygon touches consecutive parts in each row, and is drawn row by row,
/// as by a rasteriser. Over that plane the reciprocal of the L1 norm is an affine function, so its extremes
/// lie at the corners of the parts touched.
void cover_cells(const OctahedralCells& cells, const Octants& octants,
                 const std::array<LatticePoint, 3>& face, std::vector<CellCover>& covers);

} // namespace echinus
