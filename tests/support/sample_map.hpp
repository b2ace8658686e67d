#pragma once

#include <echinus/distance_map.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace echinus::test {

/// The arrays of a map, to be changed before making it.
struct MapParts {
    DistanceMapView view;
    DistanceMapStatistics statistics;
    std::uint64_t source_hash = 0;
    std::vector<std::uint32_t> entry_offsets;
    std::vector<float> entries_float32;
    std::vector<std::uint16_t> entries_unorm16;

    /// A map over copies of the arrays, whether or not they make sense.
    DistanceMap map() const {
        const auto storage = std::make_shared<const MapParts>(*this);
        DistanceMapView all = view;
        all.entry_offsets = storage->entry_offsets;
        all.entries_float32 = storage->entries_float32;
        all.entries_unorm16 = storage->entries_unorm16;
        return {all, statistics, source_hash, storage};
    }
};

/// A sound map of no particular mesh, with 0 to 4 entries in each direction.
/// @param grid  the fields of a view that describe the grid
inline MapParts random_map_parts_on(const DistanceMapView& grid, EntryFormat format, std::uint32_t seed) {
    std::mt19937 random(seed);
    MapParts parts;
    parts.view = grid;
    parts.view.centre = {1.5F, -2.0F, 0.25F};
    parts.view.radius = 3.0F + static_cast<float>(random() % 1000) / 512;
    const auto pole_axis = PoleAxis(random() % 3);
    if (has_poles(grid.grid)) parts.view.pole_axis = pole_axis;
    parts.view.entry_format = format;
    parts.view.correction = VertexCorrection(random() % 3);
    parts.view.centre_inside = random() % 2 == 0;
    parts.source_hash = (std::uint64_t{random()} << 32) + random();
    parts.entry_offsets.push_back(0);
    for (std::size_t direction = 0; direction < parts.view.direction_count(); ++direction) {
        const std::uint32_t entry_count = random() % 5;
        std::vector<std::uint16_t> steps(entry_count);
        for (auto& step : steps) step = static_cast<std::uint16_t>(random());
        std::sort(steps.begin(), steps.end());
        for (const auto step : steps) {
            if (format == EntryFormat::Unorm16) {
                parts.entries_unorm16.push_back(step);
            } else {
                parts.entries_float32.push_back(static_cast<float>(step) / 65535 *
                                                parts.view.largest_entry());
            }
        }
        parts.entry_offsets.push_back(parts.entry_offsets.back() + entry_count);
        parts.statistics.max_entries = std::max(parts.statistics.max_entries, entry_count);
    }
    parts.statistics.face_count = random();
    parts.statistics.corrected_entries = random();
    parts.statistics.wrong_parity_share = 0.25F;
    return parts;
}

inline MapParts random_map_parts(EntryFormat format, std::uint32_t longitude_count,
                                 std::uint32_t colatitude_count, std::uint32_t seed) {
    DistanceMapView grid;
    grid.longitude_count = longitude_count;
    grid.colatitude_count = colatitude_count;
    return random_map_parts_on(grid, format, seed);
}

/// On a grid with this many longitudes and colatitudes, or divisions.
inline MapParts random_map_parts(EntryFormat format, DirectionGrid kind, std::uint32_t count,
                                 std::uint32_t seed) {
    DistanceMapView grid;
    grid.grid = kind;
    (has_poles(kind) ? grid.longitude_count : grid.divisions) = count;
    if (has_poles(kind)) grid.colatitude_count = count;
    if (kind == DirectionGrid::Ellipsoidal) grid.scale = {0.25F, 1, 0.015625F};
    return random_map_parts_on(grid, format, seed);
}

} // namespace echinus::test
