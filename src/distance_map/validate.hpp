#pragma once

#include "directions/checker.hpp"

#include <echinus/distance_map.hpp>

namespace echinus {

/// Checks what a query relies on: the invariants of DistanceMapView, finite numbers, counts within the limits
/// of DistanceMapOptions, existing enumerators. One pass.
/// @throws Error Damaged
void validate(const Checker& checker, const DistanceMapView& map, const DistanceMapStatistics& statistics);

/// The last step of a build.
/// @throws Error Damaged where the map contradicts itself, through a fault of this library
DistanceMap proven(const DistanceMapView& map, const DistanceMapStatistics& statistics,
                   std::uint64_t source_hash, std::shared_ptr<const void> storage);

} // namespace echinus
