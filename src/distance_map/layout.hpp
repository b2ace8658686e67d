#pragma once

#include "directions/checker.hpp"
#include "directions/grids.hpp"
#include "directions/lattice.hpp"
#include "geometry/whole_numbers.hpp"

#include <echinus/distance_map.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace echinus {

// Directions are numbered in 32 bits, and in signed lanes of vectors; so are the products from which the
// numbers are computed.
static_assert(std::uint64_t{DistanceMapOptions::kMaxSampleCount} * DistanceMapOptions::kMaxSampleCount <
              1U << 31);
static_assert(6 * std::uint64_t{DistanceMapOptions::kMaxDivisions + 1} *
                  (DistanceMapOptions::kMaxDivisions + 1) <
              1U << 31);

/// Calls `use(grid)` with the grid that a view describes, and returns its result.
template <typename Use>
decltype(auto) with_grid(const DistanceMapView& map, const Use& use) {
    if (map.grid == DirectionGrid::Octahedral) return use(OctahedralGrid(map.divisions));
    if (map.grid == DirectionGrid::Cube) return use(CubeGrid(map.divisions));
    if (map.grid == DirectionGrid::Ellipsoidal)
        return use(EllipsoidalGrid(map.longitude_count, map.colatitude_count, map.pole_axis, map.scale));
    return use(SphericalGrid(map.longitude_count, map.colatitude_count, map.pole_axis));
}

/// Rays from the centre that are shorter than this are lengthened. The limit is far above the lengths whose
/// squares leave the range of float.
inline constexpr float kShortRay = 0x1p-50F;
inline constexpr float kRayLengthening = 0x1p100F;

inline constexpr float kUnormSteps = 65535;

inline std::uint16_t to_unorm16(float entry, float largest) {
    return truncated_to<std::uint16_t>(std::round(static_cast<double>(entry) / largest * kUnormSteps));
}
inline float from_unorm16(std::uint16_t stored, float largest) {
    return static_cast<float>(stored) * (largest / kUnormSteps);
}

/// The entry at an index of the entry arrays, whatever its format, in the mesh's unit.
inline float entry_at(const DistanceMapView& map, std::size_t position) {
    return map.entry_format == EntryFormat::Float32
               ? map.entries_float32[position]
               : from_unorm16(map.entries_unorm16[position], map.largest_entry());
}

inline std::uint32_t entry_count_of(const DistanceMapView& map, std::uint32_t direction) {
    return map.entry_offsets[direction + 1] - map.entry_offsets[direction];
}

/// Does a ray leave the solid at its k-th entry? Inside and outside alternate along the ray, starting with
/// the side of the centre (paper section 2.2).
inline bool is_outward(bool centre_inside, std::uint32_t k) {
    return (k % 2 == 0) == centre_inside;
}

/// The part of a view that is determined by the options and the mesh around its centre, before any ray is
/// cast.
DistanceMapView view_of(const DistanceMapOptions& options, const LatticeMesh& lattice);

/// Checks everything that queries rely on: the invariants of DistanceMapView, finite numbers, counts within
/// the limits of DistanceMapOptions, existing enumerators. Takes one pass.
/// @throws Error Damaged
void validate(const Checker& checker, const DistanceMapView& map, const DistanceMapStatistics& statistics);

/// The last step of a build.
/// @throws Error Damaged if the map contradicts itself, which is a fault of this library
DistanceMap proven(const DistanceMapView& map, const DistanceMapStatistics& statistics,
                   std::uint64_t source_hash, std::shared_ptr<const void> storage);

} // namespace echinus
