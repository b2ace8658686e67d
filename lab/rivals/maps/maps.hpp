#pragma once

#include "rivals/system.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/exact_map.hpp>

#include <memory>

/// The maps of Echinus as systems among others.
namespace echinus::rivals {

/// "exact". At a number of bytes: options.byte_budget.
/// @throws Error InvalidMesh for an open mesh, and as ExactMap::build() does
std::unique_ptr<const System> exact_map(const TriangleMesh& mesh, const ExactMapOptions& options = {});

/// "distance", with "octahedral" where the grid of directions is one.
/// @throws Error InvalidMesh for an open mesh, and as DistanceMap::build() does
std::unique_ptr<const System> distance_map(const TriangleMesh& mesh, const DistanceMapOptions& options = {});

/// The finest grid of directions with which the map takes at most so many bytes, to about one part in a
/// hundred: as many longitudes as colatitudes, or the divisions of an octahedron or a cube. Costs a few
/// builds.
/// @param options  its counts are not looked at
/// @return  the options with these counts
/// @throws Error as above; InvalidOptions when the coarsest map exceeds the budget
DistanceMapOptions finest_within(const TriangleMesh& mesh, std::size_t byte_budget,
                                 const DistanceMapOptions& options = {});

} // namespace echinus::rivals
