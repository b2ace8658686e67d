#pragma once

#include "directions/cast_rays.hpp"
#include "directions/lattice.hpp"

#include <echinus/distance_map.hpp>

namespace echinus {

struct CorrectionCounts {
    std::uint32_t corrected_entries = 0;
    std::uint32_t clamped_entries = 0;
};

/// Moves the entries around the mesh's vertices so that interpolation no longer misses them (paper section
/// 2.1 and figure 1b). Entries stay sorted within [0, largest_entry(R)].
CorrectionCounts correct_at_vertices(VertexCorrection correction, const LatticeMesh& lattice,
                                     const AnyGrid& grid, bool centre_inside, Crossings& crossings);

} // namespace echinus
