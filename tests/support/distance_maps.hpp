#pragma once

#include <echinus/distance_map.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

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

/// A map with given entries rather than ones built from a mesh: centre 0, R = 1, pole axis z.
class HandMadeMap {
  public:
    HandMadeMap(std::uint32_t longitude_count, std::uint32_t colatitude_count, bool centre_inside)
        : longitude_count_(longitude_count), colatitude_count_(colatitude_count),
          centre_inside_(centre_inside), lists_(std::size_t{longitude_count} * colatitude_count) {}

    std::vector<float>& entries(std::uint32_t longitude, std::uint32_t colatitude) {
        return lists_[std::size_t{colatitude} * longitude_count_ + longitude];
    }
    void fill(const std::vector<float>& entries) {
        for (auto& list : lists_) list = entries;
    }

    /// Valid as long as this object lives and is not changed.
    DistanceMapView view() {
        offsets_.assign(1, 0);
        entries_.clear();
        for (const auto& list : lists_) {
            entries_.insert(entries_.end(), list.begin(), list.end());
            offsets_.push_back(static_cast<std::uint32_t>(entries_.size()));
        }
        DistanceMapView map;
        map.radius = 1;
        map.longitude_count = longitude_count_;
        map.colatitude_count = colatitude_count_;
        map.centre_inside = centre_inside_;
        map.entry_offsets = offsets_;
        map.entries_float32 = entries_;
        return map;
    }

  private:
    std::uint32_t longitude_count_, colatitude_count_;
    bool centre_inside_;
    std::vector<std::vector<float>> lists_;
    std::vector<std::uint32_t> offsets_;
    std::vector<float> entries_;
};

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
