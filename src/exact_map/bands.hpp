#pragma once

#include "directions/lattice.hpp"
#include "directions/octahedral_cells.hpp"

#include <echinus/exact_map.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

struct Bands {
    std::vector<std::uint32_t> offsets;    ///< [cell_count + 1]
    std::vector<Band> bands;               ///< [band_count + 1]
    std::vector<std::uint32_t> references; ///< faces; edge-on faces have none
    std::vector<std::uint16_t> reference_parts;
    std::vector<std::int16_t> winding_below; ///< [band_count]
    /// Of a cell's part of the bounding sphere, but for a factor that all cells share.
    struct Volume {
        double uncertain, whole;
    };
    std::vector<Volume> uncertain_volumes; ///< [cell_count] of an open surface; none of a closed one

    void clear();
};

/// Finds the bands of every cell and the winding numbers between them, and puts them where `result` has
/// memory from another time. Does not depend on the number of threads.
/// @throws Error InvalidMesh when winding numbers or references are too large to be stored
void find_bands(const LatticeMesh& lattice, std::span<const BorderEdge> border, const OctahedralCells& cells,
                unsigned thread_count, Bands& result);

/// Faces of the band that the average reference belongs to: those that a query near the surface meets.
double expected_tests(const Bands& bands);

} // namespace echinus
