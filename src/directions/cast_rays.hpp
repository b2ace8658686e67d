#pragma once

#include "directions/grids.hpp"
#include "directions/lattice.hpp"

#include <cstdint>
#include <vector>

namespace echinus {

/// All crossings of all rays of a grid with a surface, sorted along each ray.
struct Crossings {
    std::vector<std::uint32_t>
        offsets; ///< [direction_count + 1] the crossings of direction d are [offsets[d], offsets[d + 1])
    std::vector<float> distances; ///< radial coordinates, within [0, largest_entry(R)], ascending along a ray
};

/// Casts a ray along every direction of the grid. The number of crossings of each ray is exact, even if it
/// meets an edge or a vertex; the distances are rounded. The result does not depend on the number of threads.
/// @throws Error InvalidMesh if there are 2^32 crossings or more
Crossings cast_rays(const LatticeMesh& lattice, const AnyGrid& grid, unsigned thread_count);

} // namespace echinus
