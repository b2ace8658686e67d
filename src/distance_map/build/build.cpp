// Building a distance map: paper section 2.1.

#include "directions/cast_rays.hpp"
#include "directions/lattice.hpp"
#include "distance_map/build/centre_of_fewest_errors.hpp"
#include "distance_map/build/centre_side.hpp"
#include "distance_map/build/vertex_correction.hpp"
#include "distance_map/layout.hpp"
#include "distance_map/validate.hpp"
#include "distance_map/view_of.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/mesh_hash.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

namespace {

void require_within(const char* name, std::uint32_t count, std::uint32_t least, std::uint32_t most) {
    if (count >= least && count <= most) return;
    throw Error(ErrorCode::InvalidOptions, std::string(name) + " is " + std::to_string(count) +
                                               ", outside [" + std::to_string(least) + ", " +
                                               std::to_string(most) + "]");
}

void require_usable(const DistanceMapOptions& options) {
    using Bounds = DistanceMapOptions;
    if (!has_poles(options.grid))
        return require_within("divisions", options.divisions, Bounds::kMinDivisions, Bounds::kMaxDivisions);
    require_within("longitude_count", options.longitude_count, Bounds::kMinSampleCount,
                   Bounds::kMaxSampleCount);
    require_within("colatitude_count", options.colatitude_count, Bounds::kMinSampleCount,
                   Bounds::kMaxSampleCount);
}

std::uint64_t hash_of(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    std::array<std::uint32_t, 5> fields{
        options.longitude_count, options.colatitude_count, static_cast<std::uint32_t>(options.correction),
        static_cast<std::uint32_t>(options.entry_format), static_cast<std::uint32_t>(options.pole_axis)};
    constexpr std::uint32_t kOctahedral = ~0U, kCube = ~1U; // no counts of longitudes
    constexpr std::uint32_t kEllipsoidal = 3;               // above every pole axis
    if (options.grid == DirectionGrid::Ellipsoidal) {
        fields[4] += kEllipsoidal;
    } else if (options.grid != DirectionGrid::Spherical) {
        fields[0] = options.grid == DirectionGrid::Octahedral ? kOctahedral : kCube;
        fields[1] = options.divisions;
        fields[4] = 0;
    }
    return mesh_hash(mesh, XXH64(fields.data(), sizeof fields, static_cast<std::uint64_t>(options.centre)));
}

std::uint32_t largest_count(const Crossings& crossings) {
    std::uint32_t largest = 0;
    for (std::size_t d = 0; d + 1 < crossings.offsets.size(); ++d)
        largest = std::max(largest, crossings.offsets[d + 1] - crossings.offsets[d]);
    return largest;
}

/// The arrays of a map that was built rather than loaded.
struct OwnedArrays {
    std::vector<std::uint32_t> offsets;
    std::vector<float> float32;
    std::vector<std::uint16_t> unorm16;
};

std::shared_ptr<const OwnedArrays> store(Crossings&& crossings, EntryFormat format, float largest) {
    auto arrays = std::make_shared<OwnedArrays>();
    arrays->offsets = std::move(crossings.offsets);
    if (format == EntryFormat::Float32) {
        arrays->float32 = std::move(crossings.distances);
    } else {
        arrays->unorm16.reserve(crossings.distances.size());
        for (float distance : crossings.distances) arrays->unorm16.push_back(to_unorm16(distance, largest));
    }
    return arrays;
}

LatticeMesh snap(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    return options.centre == CentreChoice::Search ? snap_around_best_centre(mesh, options)
                                                  : snap_to_lattice(mesh);
}

} // namespace

DistanceMap DistanceMap::build(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    require_usable(options);
    const LatticeMesh lattice = snap(mesh, options);
    DistanceMapView view = view_of(options, lattice);
    view.origin = mesh.origin;
    const AnyGrid grid = with_grid(view, [](const auto& one) { return AnyGrid(one); });

    Crossings crossings = cast_rays(lattice, grid, options.thread_count);
    const CentreSide centre = side_of_centre(crossings, grid);
    view.centre_inside = centre.inside;
    const CorrectionCounts counts =
        correct_at_vertices(options.correction, lattice, grid, centre.inside, crossings);

    DistanceMapStatistics statistics;
    statistics.face_count = kept_as<std::uint32_t>(mesh.faces.size());
    statistics.dropped_faces = kept_as<std::uint32_t>(mesh.faces.size() - lattice.faces.size());
    statistics.max_entries = largest_count(crossings);
    statistics.corrected_entries = counts.corrected_entries;
    statistics.clamped_entries = counts.clamped_entries;
    statistics.wrong_parity_share = centre.wrong_parity_share;

    const auto arrays = store(std::move(crossings), options.entry_format, view.largest_entry());
    view.entry_offsets = arrays->offsets;
    view.entries_float32 = arrays->float32;
    view.entries_unorm16 = arrays->unorm16;
    return proven(view, statistics, hash_of(mesh, options), arrays);
}

} // namespace echinus
