// The surface that a map describes, for figures: the paper's figures 2 and 3.

#include "distance_map/layout.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace echinus {

namespace {

/// One vertex per entry, at the entry's index in the entry arrays.
template <typename Grid>
std::vector<Vec3f> entry_points(const DistanceMapView& map, const Grid& grid) {
    std::vector<Vec3f> points;
    points.reserve(map.entry_count());
    std::size_t d = 0;
    for (const Vec3d& direction : grid.directions()) {
        for (std::uint32_t entry = map.entry_offsets[d]; entry < map.entry_offsets[d + 1]; ++entry)
            points.push_back(map.centre + Vec3f(direction) * entry_at(map, entry));
        ++d;
    }
    return points;
}

/// Adds a face of layer k between three directions that are counter-clockwise seen from outside the sphere.
void add_face(const DistanceMapView& map, const Triangle& directions, std::uint32_t k, MapSurface& surface) {
    Triangle face;
    for (std::size_t c = 0; c < 3; ++c) face[c] = map.entry_offsets[directions[c]] + k;
    if (!is_outward(map.centre_inside, k)) std::swap(face[1], face[2]);
    surface.mesh.faces.push_back(face);
    surface.layer.push_back(k);
}

/// Adds the layers of a facet of the grid whose samples have equal entry counts, each layer as a fan.
void add_layers(const DistanceMapView& map, std::span<const std::uint32_t> facet, MapSurface& surface) {
    const std::uint32_t count = entry_count_of(map, facet[0]);
    const auto has_other_count = [&](std::uint32_t d) { return entry_count_of(map, d) != count; };
    if (std::any_of(facet.begin(), facet.end(), has_other_count)) return;
    for (std::uint32_t k = 0; k < count; ++k)
        for (std::size_t i = 1; i + 1 < facet.size(); ++i)
            add_face(map, {facet[0], facet[i], facet[i + 1]}, k, surface);
}

} // namespace

MapSurface reconstruct_surface(const DistanceMapView& map) {
    return with_grid(map, [&](const auto& grid) {
        MapSurface surface;
        surface.mesh.vertices = entry_points(map, grid);
        surface.mesh.origin = map.origin;
        grid.for_each_facet([&](const auto& facet) { add_layers(map, facet, surface); });
        return surface;
    });
}

} // namespace echinus
