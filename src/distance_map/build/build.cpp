// Building a distance map: paper section 2.1.

#include "directions/cast_rays.hpp"
#include "directions/grids.hpp"
#include "directions/lattice.hpp"
#include "distance_map/build/vertex_correction.hpp"
#include "distance_map/layout.hpp"
#include "geometry/whole_numbers.hpp"
#include "mesh/mesh_hash.hpp"

#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace echinus {

namespace {

/// Is the centre inside, judged by the parity of each ray's crossings, weighted by the ray's solid angle? On
/// a closed mesh all rays agree; on an open one the majority decides.
struct CentreSide {
    bool inside;
    float wrong_parity_share; ///< share of the directions
};

CentreSide side_of_centre(const Crossings& crossings, const AnyGrid& any_grid) {
    const std::vector<double> solid_angles =
        std::visit([](const auto& grid) { return grid.solid_angle_weights(); }, any_grid);
    double odd_weight = 0;
    double weight = 0;
    std::size_t odd_count = 0;
    for (std::size_t d = 0; d < solid_angles.size(); ++d) {
        const bool odd = (crossings.offsets[d + 1] - crossings.offsets[d]) % 2 == 1;
        odd_weight += odd ? solid_angles[d] : 0;
        weight += solid_angles[d];
        odd_count += odd ? 1 : 0;
    }
    const std::size_t direction_count = solid_angles.size();
    const bool inside = odd_weight > weight / 2;
    const std::size_t wrong_count = inside ? direction_count - odd_count : odd_count;
    return {inside, static_cast<float>(wrong_count) / static_cast<float>(direction_count)};
}

/// Points close to the surface, on both sides of it, each with the area of the surface that it represents.
class PlacesBesideSurface {
  public:
    PlacesBesideSurface(const TriangleMesh& mesh, float offset) {
        constexpr double kMinPlaces = 4000;
        const auto cuts = truncated_to<std::uint32_t>(
            std::ceil(std::sqrt(kMinPlaces / static_cast<double>(mesh.faces.size()))));
        for (const Triangle& face : mesh.faces) {
            const Vec3d a(mesh.vertices[face[0]]);
            add({a, Vec3d(mesh.vertices[face[1]]) - a, Vec3d(mesh.vertices[face[2]]) - a}, cuts,
                static_cast<double>(offset));
        }
        inside_.resize(outer_.size());
    }

    /// The share of the surface near which a map is wrong. For an inside-out mesh, inside and outside are
    /// swapped.
    double wrong_share(const DistanceMapView& map) {
        double wrong = 0, all = 0;
        const auto judge = [&](const std::vector<Vec3f>& places, std::uint8_t expected) {
            contains_batch(map, places, inside_);
            for (std::size_t i = 0; i < places.size(); ++i) {
                all += areas_[i];
                wrong += inside_[i] == expected ? 0 : areas_[i];
            }
        };
        judge(outer_, 0);
        judge(inner_, 1);
        const double share = all > 0 ? wrong / all : 0;
        return std::min(share, 1 - share);
    }

  private:
    struct Face {
        Vec3d corner, u, v;
    };

    /// Adds points at the centroids of the cuts^2 small triangles into which a face is cut.
    void add(const Face& face, std::uint32_t cuts, double offset) {
        const Vec3d normal = cross(face.u, face.v);
        const double area = length(normal);
        if (!(area > 0)) return;
        const Vec3d step = normal * (offset / area);
        const auto add_at = [&](double i, double j) {
            const Vec3d place = face.corner + face.u * (i / cuts) + face.v * (j / cuts);
            outer_.push_back(Vec3f(place + step));
            inner_.push_back(Vec3f(place - step));
            areas_.push_back(area / (static_cast<double>(cuts) * cuts));
        };
        for (std::uint32_t i = 0; i < cuts; ++i)
            for (std::uint32_t j = 0; i + j < cuts; ++j) {
                add_at(i + 1.0 / 3, j + 1.0 / 3);
                if (i + j + 1 < cuts) add_at(i + 2.0 / 3, j + 2.0 / 3);
            }
    }

    std::vector<Vec3f> outer_, inner_;
    std::vector<double> areas_;
    std::vector<std::uint8_t> inside_;
};

/// The options of the requested map with a quarter of the directions: finer maps cost more and rank centres
/// alike.
DistanceMapOptions coarse(DistanceMapOptions options) {
    const auto halved = [](std::uint32_t count) { return std::max(count / 2, 4U); };
    options.longitude_count = halved(options.longitude_count);
    options.colatitude_count = halved(options.colatitude_count);
    options.divisions = halved(options.divisions);
    options.entry_format = EntryFormat::Float32;
    return options;
}

/// Snaps the mesh to the lattice of a centre around which coarse maps of the requested kind are wrong at few
/// points near the surface. Builds 19 such maps.
/// @throws Error as LatticeSnapper::snap()
LatticeMesh snap_around_best_centre(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    LatticeSnapper snapper(mesh.faces);
    LatticeMesh best;
    snapper.snap(mesh.vertices, best);
    constexpr float kOffset = 0.005F; // in radii
    PlacesBesideSurface places(mesh, kOffset * best.radius);
    const auto cost_of = [&](const LatticeMesh& lattice) {
        DistanceMapView map = view_of(coarse(options), lattice);
        const AnyGrid grid = with_grid(map, [](const auto& one) { return AnyGrid(one); });
        const Crossings crossings = cast_rays(lattice, grid, options.thread_count);
        map.centre_inside = side_of_centre(crossings, grid).inside;
        map.entry_offsets = crossings.offsets;
        map.entries_float32 = crossings.distances;
        return places.wrong_share(map);
    };
    snap_at_lowest_cost(snapper, mesh.vertices, cost_of, best);
    return best;
}

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
    constexpr std::uint32_t kOctahedral = ~0U, kCube = ~1U; // values that no count of longitudes has
    constexpr std::uint32_t kEllipsoidal = 3;               // greater than every pole axis
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
