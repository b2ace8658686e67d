#pragma once

#include <echinus/distance_map.hpp>

#include <string>

namespace echinus {

/// The remedy that every sentence about a bad map file ends with.
inline constexpr const char* kBuildAgain = "; build the map again with echinus build";

/// Checks what a query relies on: the invariants of DistanceMapView, numbers that are finite, counts within
/// the limits of DistanceMapOptions, enumerators that exist. For arrays from untrusted bytes; one pass.
/// @throws Error Damaged; the sentence begins with `name` and names the field or the array and the index
void validate(const DistanceMapView& map, const DistanceMapStatistics& statistics, const std::string& name);

} // namespace echinus
