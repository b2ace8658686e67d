#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

struct Bands {
    std::vector<std::uint32_t> offsets;    ///< [cell_count + 1]
    std::vector<Band> bands;               ///< [band_count + 1]
    std::vector<std::uint32_t> references; ///< faces, ascending within a band; edge-on faces have none
    std::vector<std::uint16_t> reference_parts;
    std::vector<std::int16_t> winding_below; ///< [band_count]
};

/// Finds the bands of every cell and the winding numbers between them. Does not depend on the number of
/// threads.
/// @pre the mesh is closed
Bands find_bands(const LatticeMesh& lattice, const OctahedralCells& cells, unsigned thread_count);

} // namespace echinus
