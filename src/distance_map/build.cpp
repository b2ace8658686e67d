// Building a distance map: paper section 2.1.

#include "directions/crossings.hpp"
#include "directions/lattice.hpp"
#include "directions/spherical_grid.hpp"
#include "distance_map/layout.hpp"
#include "distance_map/vertex_correction.hpp"
#include "mesh/mesh_hash.hpp"

#include <echinus/error.hpp>

#include <algorithm>
#include <string>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

namespace {

void require_sample_count(const char* name, std::uint32_t count) {
    if (count >= DistanceMapOptions::kMinSampleCount && count <= DistanceMapOptions::kMaxSampleCount) return;
    throw Error(ErrorCode::InvalidOptions, std::string(name) + " is " + std::to_string(count) +
                                               ", outside [" +
                                               std::to_string(DistanceMapOptions::kMinSampleCount) + ", " +
                                               std::to_string(DistanceMapOptions::kMaxSampleCount) + "]");
}

/// Is the centre inside, judged by the parity of each ray and weighed by the solid angle that the ray stands
/// for? On a closed mesh all rays agree; on an open one the majority of the sphere decides.
struct CentreSide {
    bool inside;
    float wrong_parity_share;
};

CentreSide side_of_centre(const Crossings& crossings, const SphericalGrid& grid) {
    double odd_weight = 0;
    double weight = 0;
    std::size_t odd_count = 0;
    for (std::uint32_t j = 0; j < grid.colatitude_count(); ++j) {
        std::size_t odd_in_row = 0;
        for (std::uint32_t i = 0; i < grid.longitude_count(); ++i) {
            const std::uint32_t d = grid.index(i, j);
            odd_in_row += (crossings.offsets[d + 1] - crossings.offsets[d]) % 2;
        }
        const double solid_angle = grid.solid_angle_weight(j);
        odd_weight += solid_angle * static_cast<double>(odd_in_row);
        weight += solid_angle * grid.longitude_count();
        odd_count += odd_in_row;
    }
    const std::size_t direction_count = crossings.offsets.size() - 1;
    const bool inside = odd_weight > weight / 2;
    const std::size_t wrong_count = inside ? direction_count - odd_count : odd_count;
    return {inside, static_cast<float>(wrong_count) / static_cast<float>(direction_count)};
}

std::uint64_t hash_of(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    const std::array<std::uint32_t, 5> fields{
        options.longitude_count, options.colatitude_count, static_cast<std::uint32_t>(options.correction),
        static_cast<std::uint32_t>(options.entry_format), static_cast<std::uint32_t>(options.pole_axis)};
    return mesh_hash(mesh, XXH64(fields.data(), sizeof fields, 0));
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

std::shared_ptr<const OwnedArrays> store(Crossings&& crossings, EntryFormat format, float radius) {
    auto arrays = std::make_shared<OwnedArrays>();
    arrays->offsets = std::move(crossings.offsets);
    if (format == EntryFormat::Float32) {
        arrays->float32 = std::move(crossings.distances);
    } else {
        arrays->unorm16.reserve(crossings.distances.size());
        for (float distance : crossings.distances) arrays->unorm16.push_back(to_unorm16(distance, radius));
    }
    return arrays;
}

} // namespace

DistanceMap DistanceMap::build(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    require_sample_count("longitude_count", options.longitude_count);
    require_sample_count("colatitude_count", options.colatitude_count);
    const LatticeMesh lattice = snap_to_lattice(mesh);
    const SphericalGrid grid(options.longitude_count, options.colatitude_count, options.pole_axis);
    Crossings crossings = cast_rays(lattice, grid, options.thread_count);
    const CentreSide centre = side_of_centre(crossings, grid);
    const CorrectionCounts counts =
        correct_at_vertices(options.correction, lattice, grid, centre.inside, crossings);

    DistanceMapStatistics statistics;
    statistics.face_count = static_cast<std::uint32_t>(mesh.faces.size());
    statistics.dropped_faces = static_cast<std::uint32_t>(mesh.faces.size() - lattice.faces.size());
    statistics.max_entries = largest_count(crossings);
    statistics.corrected_entries = counts.corrected_entries;
    statistics.clamped_entries = counts.clamped_entries;
    statistics.wrong_parity_share = centre.wrong_parity_share;

    const auto arrays = store(std::move(crossings), options.entry_format, lattice.radius);
    DistanceMapView view;
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.longitude_count = options.longitude_count;
    view.colatitude_count = options.colatitude_count;
    view.pole_axis = options.pole_axis;
    view.entry_format = options.entry_format;
    view.correction = options.correction;
    view.centre_inside = centre.inside;
    view.entry_offsets = arrays->offsets;
    view.entries_float32 = arrays->float32;
    view.entries_unorm16 = arrays->unorm16;
    return {view, statistics, hash_of(mesh, options), arrays};
}

} // namespace echinus
