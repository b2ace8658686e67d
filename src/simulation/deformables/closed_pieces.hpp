#pragma once

#include <echinus/simulation.hpp>

#include <vector>

namespace echinus {

/// The faces of cloth that belong to closed pieces of it, turned so that their fronts look outwards: of a
/// piece that encloses no volume at rest as it begins, and of one that encloses none then either as the faces
/// have them.
/// @pre the deformable is valid
std::vector<Triangle> closed_pieces(const Deformable& deformable);

} // namespace echinus
