#pragma once

#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// The faces of cloth that belong to closed pieces, turned so that their fronts look outwards. Outwards is
/// decided at rest; for a piece that encloses no volume at rest, at the start; for a piece that encloses none
/// at the start either, the faces remain as they are.
/// @pre the deformable is valid
std::vector<Triangle> closed_pieces(const Deformable& deformable);

} // namespace echinus
