#include "distance_map/layout.hpp"

#include "directions/spherical_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

namespace echinus {

DistanceMap::DistanceMap(const DistanceMapView& view, const DistanceMapStatistics& statistics,
                         std::uint64_t source_hash, std::shared_ptr<const void> storage)
    : view_(view), statistics_(statistics), source_hash_(source_hash), storage_(std::move(storage)) {}

std::size_t DistanceMapView::direction_count() const {
    return with_grid(*this, [](const auto& one) { return one.direction_count(); });
}

float DistanceMapView::largest_entry() const {
    return with_grid(*this, [this](const auto& one) { return one.largest_entry(radius); });
}

std::vector<std::size_t> entry_histogram(const DistanceMapView& map) {
    std::vector<std::size_t> histogram;
    const std::size_t direction_count = map.direction_count();
    for (std::uint32_t direction = 0; direction < direction_count; ++direction) {
        const std::uint32_t count = entry_count_of(map, direction);
        if (histogram.size() <= count) histogram.resize(count + 1);
        ++histogram[count];
    }
    return histogram;
}

namespace {

/// The scale that turns the mesh's box around the centre into a cube, unless the box is thinner than the grid
/// allows: the shortest half edge keeps its length, the others are shortened to it.
Vec3f scale_of(const LatticeMesh& lattice) {
    LatticePoint reach;
    for (const LatticePoint& v : lattice.vertices)
        reach = {std::max(reach.x, std::abs(v.x)), std::max(reach.y, std::abs(v.y)),
                 std::max(reach.z, std::abs(v.z))};
    const Vec3d half(reach);
    const double least = std::max({half.x, half.y, half.z}) * double{EllipsoidalGrid::kSmallestScale};
    const double shortest = std::max(std::min({half.x, half.y, half.z}), least);
    const auto of_axis = [&](double edge) { return static_cast<float>(shortest / std::max(edge, shortest)); };
    return {of_axis(half.x), of_axis(half.y), of_axis(half.z)};
}

} // namespace

DistanceMapView view_of(const DistanceMapOptions& options, const LatticeMesh& lattice) {
    DistanceMapView view;
    view.centre = lattice.centre;
    view.radius = lattice.radius;
    view.grid = options.grid;
    if (has_poles(options.grid)) {
        view.longitude_count = options.longitude_count;
        view.colatitude_count = options.colatitude_count;
        view.pole_axis = options.pole_axis;
    } else {
        view.divisions = options.divisions;
    }
    if (options.grid == DirectionGrid::Ellipsoidal) view.scale = scale_of(lattice);
    view.entry_format = options.entry_format;
    view.correction = options.correction;
    return view;
}

} // namespace echinus
