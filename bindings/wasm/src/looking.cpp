// Inspects maps: their surfaces and cells, and their data along one ray.

#include "arrays.hpp"
#include "directions/face_cone.hpp"
#include "directions/octahedral_cells.hpp"
#include "distance_map/interpolation.hpp"
#include "exact_map/layout.hpp"
#include "interface.hpp"

#include <echinus/any_map.hpp>
#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace echinus::wasm {

namespace {

/// @throws Error InvalidOptions
Vec3d unit_direction(double x, double y, double z) {
    const Vec3d direction{x, y, z};
    const double size = length(direction);
    if (!(size > 0) || !std::isfinite(size))
        throw Error(ErrorCode::InvalidOptions,
                    "the squared length of a ray's direction must be finite and greater than 0");
    return direction * (1 / size);
}

/// An interval of a ray on which the answer does not change.
json interval(double from, double to, bool inside, bool certain = true) {
    return {{"from", from}, {"to", to}, {"inside", inside}, {"certain", certain}};
}

// ---- Exact maps

/// Distances from the centre at which a ray crosses the faces that a cell lists, ascending.
std::vector<double> crossings_of(const ExactMapView& map, const BandRange& bands, const LatticePoint& along) {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t band = bands.first; band < bands.last; ++band)
        for (std::uint32_t r = map.bands[band].first_reference; r < map.bands[band + 1].first_reference; ++r)
            faces.push_back(map.references[r]);
    std::sort(faces.begin(), faces.end()); // a face is listed by each of the bands that it passes through
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    const double unit = length(Vec3d(along)) * frame_of(map).step;
    std::vector<double> distances;
    for (const std::uint32_t face : faces) {
        const auto [a, b, c] = face_corners(map, face);
        const FaceCone cone(a, b, c);
        if (!cone.edge_on() && cone.meets(along)) distances.push_back(cone.parameter(along) * unit);
    }
    std::sort(distances.begin(), distances.end());
    return distances;
}

json bands_along(const ExactMapView& map, const BandRange& bands, double length_per_unit) {
    json result = json::array();
    for (std::uint32_t band = bands.first; band < bands.last; ++band) {
        const Band& b = map.bands[band];
        const int winding = map.winding_below[band];
        const bool known = winding != ExactMapView::kUncertain && winding != ExactMapView::kSplit;
        result.push_back({{"from", b.lower * length_per_unit},
                          {"to", b.upper * length_per_unit},
                          {"faceCount", map.bands[band + 1].first_reference - b.first_reference},
                          {"windingBelow", known ? json(winding) : json()}});
    }
    return result;
}

/// The side does not change between crossings, so each interval is classified at its middle.
json intervals_along(const ExactMapView& map, const std::vector<double>& crossings, const Vec3d& unit) {
    json result = json::array();
    double from = 0;
    const auto add = [&](double to) {
        if (!(to > from)) return;
        const Containment side = classify(map, Vec3f(Vec3d(map.centre) + unit * ((from + to) / 2)));
        result.push_back(interval(from, to, side.inside, side.certain));
        from = to;
    };
    for (const double distance : crossings) add(distance);
    add(double{map.radius});
    return result;
}

json corners_of_cell(const OctahedralCells& cells, std::uint32_t cell) {
    json result = json::array();
    for (const Vec3d& corner : cells.corners(cell)) {
        const Vec3d unit = corner * (1 / length(corner));
        result.push_back({unit.x, unit.y, unit.z});
    }
    return result;
}

json look_along(const ExactMapView& map, const Vec3d& unit) {
    const LatticePoint along = lattice_direction(unit);
    const OctahedralCells cells(map.divisions);
    const std::uint32_t cell = cells.locate(along).cell;
    const BandRange bands = bands_of_cell(map, cell);
    const double l1_per_length = std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z);
    const double length_per_unit = ExactMapView::kBandUnit * frame_of(map).step / l1_per_length;
    const std::vector<double> crossings = crossings_of(map, bands, along);
    return {{"cell", cell},
            {"cellCorners", corners_of_cell(cells, cell)},
            {"bands", bands_along(map, bands, length_per_unit)},
            {"crossings", crossings},
            {"intervals", intervals_along(map, crossings, unit)}};
}

// ---- Distance maps

/// The values that a query for a particle on this ray interpolates.
template <typename Grid>
json look_along(const DistanceMapView& map, const Grid& grid, const Vec3f& unit) {
    const auto at = grid.coordinates_of(grid.to_grid(unit));
    const Interpolation<Grid> samples = interpolation_at(map, grid, grid.cell_at(at));
    std::vector<double> crossings;
    json intervals = json::array();
    double from = 0;
    for (std::uint32_t k = 0; k <= samples.entry_count; ++k) {
        const bool last = k == samples.entry_count;
        const double to = last ? map.radius : Grid::distance_of(interpolated(map, samples, k), at);
        if (!last) crossings.push_back(to);
        if (to > from) intervals.push_back(interval(from, to, (k % 2 == 0) == map.centre_inside));
        from = std::max(from, to);
    }
    std::array<std::uint32_t, 4> entry_counts{};
    for (std::size_t corner = 0; corner < 4; ++corner)
        entry_counts[corner] = entry_count_of(map, samples.cell.corners[corner]);
    return {{"samples", samples.cell.corners},
            {"sampleEntryCounts", entry_counts},
            {"samplesUsed", samples.usable},
            {"crossings", crossings},
            {"intervals", intervals}};
}

json look_along(const DistanceMapView& map, const Vec3d& unit) {
    return with_grid(map, [&](const auto& grid) { return look_along(map, grid, Vec3f(unit)); });
}

// ---- Surfaces and cells

/// A surface to colour: the layer of each face, or the longest list that contains it.
struct ColouredSurface {
    TriangleMesh mesh;
    std::vector<std::uint32_t> classes;
};

ColouredSurface surface_of(const ExactMap& map) {
    ExactMapSurface surface = reconstruct_surface(map.view());
    return {std::move(surface.mesh), std::move(surface.longest_list)};
}
ColouredSurface surface_of(const DistanceMap& map) {
    MapSurface surface = reconstruct_surface(map.view());
    return {std::move(surface.mesh), std::move(surface.layer)};
}

/// @return  numbers: bands of each cell, faces in all lists of each cell; floats: unit vectors to each cell's
/// three corners
Arrays cells_of(const ExactMapView& map) {
    Arrays result;
    const OctahedralCells cells(map.divisions);
    for (std::uint32_t cell = 0; cell < map.cell_count(); ++cell) {
        const BandRange bands = bands_of_cell(map, cell);
        result.numbers[0].push_back(bands.last - bands.first);
        result.numbers[1].push_back(map.bands[bands.last].first_reference -
                                    map.bands[bands.first].first_reference);
        for (const Vec3d& corner : cells.corners(cell)) {
            const Vec3d unit = corner * (1 / length(corner));
            for (const double c : {unit.x, unit.y, unit.z}) result.floats[0].push_back(static_cast<float>(c));
        }
    }
    return result;
}

} // namespace

ECHINUS_EXPORT(map_ray) Text* map_ray(const AnyMap* map, double x, double y, double z) {
    return make_json([&] {
        const Vec3d unit = unit_direction(x, y, z);
        return std::visit([&](const auto& kind) { return look_along(kind.view(), unit); }, *map);
    });
}

ECHINUS_EXPORT(map_surface) ColouredSurface* map_surface(const AnyMap* map) {
    return make_handle([&] { return std::visit([](const auto& kind) { return surface_of(kind); }, *map); });
}
/// Moves the mesh out.
ECHINUS_EXPORT(surface_mesh) TriangleMesh* surface_mesh(ColouredSurface* surface) {
    return make_handle([&] { return std::move(surface->mesh); });
}
/// [face_count]
ECHINUS_EXPORT(surface_classes) const std::uint32_t* surface_classes(const ColouredSurface* surface) {
    return surface->classes.data();
}
ECHINUS_EXPORT(surface_delete) void surface_delete(ColouredSurface* surface) {
    delete surface;
}

/// Of an exact map.
ECHINUS_EXPORT(map_cells) Arrays* map_cells(const AnyMap* map) {
    return make_handle([&] { return cells_of(std::get<ExactMap>(*map).view()); });
}

} // namespace echinus::wasm
