#pragma once

#include <echinus/distance_map.hpp>

#include <cstdint>

namespace echinus::test {

inline constexpr DirectionGrid kEveryGrid[] = {DirectionGrid::Spherical, DirectionGrid::Octahedral,
                                               DirectionGrid::Cube, DirectionGrid::Ellipsoidal};

inline const char* name_of(DirectionGrid grid) {
    constexpr const char* kNames[] = {"Spherical", "Octahedral", "Cube", "Ellipsoidal"};
    return kNames[static_cast<std::size_t>(grid)];
}

/// A grid of about 2 resolution x 2 resolution samples, whatever its kind.
inline DistanceMapOptions options_of(DirectionGrid grid, std::uint32_t resolution,
                                     VertexCorrection correction = VertexCorrection::None,
                                     EntryFormat format = EntryFormat::Float32) {
    return {.grid = grid,
            .longitude_count = 2 * resolution,
            .colatitude_count = 2 * resolution,
            .divisions = grid == DirectionGrid::Cube ? resolution * 4 / 5 : resolution,
            .correction = correction,
            .entry_format = format};
}

} // namespace echinus::test
