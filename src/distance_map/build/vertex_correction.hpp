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

/// How rays cross the faces around a vertex: None if no face uses it, Both if it lies on a silhouette.
enum class Facing : std::uint8_t { None, Outward, Inward, Both };

/// The position of a vertex among the crossings of its own ray, the one from the centre through it.
struct VertexLayer {
    Facing facing = Facing::None;
    std::uint32_t crossings_before = 0; ///< crossings nearer than the vertex, without the faces around it
    std::uint32_t crossing_count = 0;   ///< crossings of the whole ray, including the faces around the vertex
};

/// [vertex_count] The layer of each vertex; exact, like the crossings of the grid's own rays.
/// @param grid  used to find the faces that a vertex's ray may meet; any resolution gives the same result
std::vector<VertexLayer> layers_of_vertices(const LatticeMesh& lattice, const SphericalGrid& grid);

} // namespace echinus
