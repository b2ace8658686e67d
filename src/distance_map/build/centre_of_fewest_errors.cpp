#include "distance_map/build/centre_of_fewest_errors.hpp"

#include "directions/cast_rays.hpp"
#include "directions/lattice.hpp"
#include "distance_map/build/centre_side.hpp"
#include "distance_map/layout.hpp"
#include "distance_map/view_of.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

namespace {

/// Places just beside the surface, on both sides of it, each with the share of the surface that it
/// represents.
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

    /// The share of the surface beside which a map is wrong. For an inside-out mesh, inside and outside are
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

    /// The middles of the cuts^2 small triangles that a face is cut into.
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

/// The options of the wanted map with a quarter of the directions: finer maps cost more and rank centres
/// alike.
DistanceMapOptions coarse(DistanceMapOptions options) {
    const auto halved = [](std::uint32_t count) { return std::max(count / 2, 4U); };
    options.longitude_count = halved(options.longitude_count);
    options.colatitude_count = halved(options.colatitude_count);
    options.divisions = halved(options.divisions);
    options.entry_format = EntryFormat::Float32;
    return options;
}

} // namespace

LatticeMesh snap_around_best_centre(const TriangleMesh& mesh, const DistanceMapOptions& options) {
    LatticeSnapper snapper(mesh.faces);
    LatticeMesh best;
    snapper.snap(mesh.vertices, best);
    constexpr float kOffset = 0.005F; // of the radius
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

} // namespace echinus
