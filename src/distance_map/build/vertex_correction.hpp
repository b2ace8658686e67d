#pragma once

#include "directions/cast_rays.hpp"
#include "directions/lattice.hpp"
#include "directions/spherical_grid.hpp"

#include <echinus/distance_map.hpp>

#include <cstdint>
#include <vector>

namespace echinus {

struct CorrectionCounts {
    std::uint32_t corrected_entries = 0;
    std::uint32_t clamped_entries = 0;
};

/// Moves the entries around the mesh's vertices so that interpolation no longer misses them (paper section
/// 2.1 and figure 1b). Entries stay sorted within [0, largest_entry(R)].
CorrectionCounts correct_at_vertices(VertexCorrection correction, const LatticeMesh& lattice,
                                     const AnyGrid& grid, bool centre_inside, Crossings& crossings);

/// How the rays cross the faces around a vertex. A vertex that no face uses has none; one with faces of both
/// kinds lies on a silhouette.
enum class Facing : std::uint8_t { None, Outward, Inward, Both };

/// Where a vertex lies among the crossings of its own ray, the one from the centre through it.
struct VertexLayer {
    Facing facing = Facing::None;
    std::uint32_t crossings_before = 0; ///< nearer than the vertex, the faces around it not counted
    std::uint32_t crossing_count = 0;   ///< of the whole ray, the faces around the vertex included
};

/// [vertex_count] Exact, like the crossings of the grid's own rays.
/// @param grid  finds the faces that a vertex's ray may meet; any resolution gives the same answer
std::vector<VertexLayer> layers_of_vertices(const LatticeMesh& lattice, const SphericalGrid& grid);

} // namespace echinus
