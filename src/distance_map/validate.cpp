#include "directions/spherical_grid.hpp"
#include "distance_map/layout.hpp"

#include <cmath>
#include <utility>

namespace echinus {

namespace {

constexpr std::uint16_t kMaxUnorm16 = 65535;

bool is_float(const DistanceMapView& map) {
    return map.entry_format == EntryFormat::Float32;
}

void check_sample_count(const Checker& checker, std::string_view field, std::uint32_t count) {
    checker.check_range(field, count, DistanceMapOptions::kMinSampleCount,
                        DistanceMapOptions::kMaxSampleCount);
}

/// Fields that the map's grid does not use must be 0.
void check_counts(const Checker& checker, const DistanceMapView& map) {
    if (has_poles(map.grid)) {
        check_sample_count(checker, "longitude_count", map.longitude_count);
        check_sample_count(checker, "colatitude_count", map.colatitude_count);
        checker.check_equal("divisions", map.divisions, 0);
    } else {
        checker.check_equal("longitude_count", map.longitude_count, 0);
        checker.check_equal("colatitude_count", map.colatitude_count, 0);
        checker.check_range("divisions", map.divisions, DistanceMapOptions::kMinDivisions,
                            DistanceMapOptions::kMaxDivisions);
    }
}

/// Only the frame of an ellipsoidal grid may be scaled.
void check_scale(const Checker& checker, const DistanceMapView& map) {
    const float least = map.grid == DirectionGrid::Ellipsoidal ? EllipsoidalGrid::kSmallestScale : 1.0F;
    for (const float scale : {map.scale.x, map.scale.y, map.scale.z})
        checker.check_range("scale", scale, least, 1.0F);
}

void check_scalars(const Checker& checker, const DistanceMapView& map) {
    if (!is_finite(map.centre)) checker.fail("centre is not finite");
    if (!std::isfinite(map.radius) || !(map.radius > 0))
        checker.fail("radius is not a positive finite number");
    checker.check_enumerator("grid", map.grid, DirectionGrid::Ellipsoidal);
    check_counts(checker, map);
    check_scale(checker, map);
    // Reciprocals and quotients of lengths must be finite; the range is that of a build, with allowance for
    // rounding.
    if (map.grid != DirectionGrid::Spherical) checker.check_range("radius", map.radius, 1e-15F, 4e15F);
    checker.check_enumerator("pole_axis", map.pole_axis, PoleAxis::Z);
    checker.check_enumerator("entry_format", map.entry_format, EntryFormat::Unorm16);
    checker.check_enumerator("vertex_correction", map.correction, VertexCorrection::Signed);
}

/// Checks that the entries of a direction ascend within [0, max]. NaN fails.
template <typename T>
void check_entries(const Checker& checker, std::string_view array, std::span<const std::uint32_t> offsets,
                   std::span<const T> entries, T max) {
    for (std::size_t direction = 0; direction + 1 < offsets.size(); ++direction) {
        T least = 0;
        for (std::size_t i = offsets[direction]; i < offsets[direction + 1]; ++i) {
            if (!(entries[i] >= least && entries[i] <= max)) {
                checker.fail(array, i,
                             "is " + std::to_string(entries[i]) + " and not within " + std::to_string(least) +
                                 " to " + std::to_string(max));
            }
            least = entries[i];
        }
    }
}

void check_entries(const Checker& checker, const DistanceMapView& map) {
    checker.check_size("entries_float32", map.entries_float32.size(), is_float(map) ? map.entry_count() : 0);
    checker.check_size("entries_unorm16", map.entries_unorm16.size(), is_float(map) ? 0 : map.entry_count());
    if (is_float(map)) {
        check_entries(checker, "entries_float32", map.entry_offsets, map.entries_float32,
                      map.largest_entry());
    } else {
        check_entries(checker, "entries_unorm16", map.entry_offsets, map.entries_unorm16, kMaxUnorm16);
    }
}

void check_statistics(const Checker& checker, const DistanceMapView& map,
                      const DistanceMapStatistics& statistics) {
    std::uint32_t max_entries = 0;
    for (std::size_t i = 0; i + 1 < map.entry_offsets.size(); ++i) {
        max_entries = std::max(max_entries, map.entry_offsets[i + 1] - map.entry_offsets[i]);
    }
    checker.check_equal("max_entries", statistics.max_entries, max_entries);
    checker.check_range("wrong_parity_share", statistics.wrong_parity_share, 0.0F, 1.0F);
}

} // namespace

void validate(const Checker& checker, const DistanceMapView& map, const DistanceMapStatistics& statistics) {
    check_scalars(checker, map);
    checker.check_offsets("entry_offsets", map.entry_offsets, map.direction_count());
    check_entries(checker, map);
    check_statistics(checker, map, statistics);
}

DistanceMap proven(const DistanceMapView& map, const DistanceMapStatistics& statistics,
                   std::uint64_t source_hash, std::shared_ptr<const void> storage) {
    validate(Checker::of_build(), map, statistics);
    return {map, statistics, source_hash, std::move(storage)};
}

} // namespace echinus
