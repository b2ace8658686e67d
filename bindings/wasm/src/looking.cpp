// Looks into maps: their layout and cells, and their data along one ray.

#include "directions/face_cone.hpp"
#include "directions/octahedral_cells.hpp"
#include "distance_map/interpolation.hpp"
#include "exact_map/layout.hpp"
#include "interface.hpp"

#include <echinus/any_map.hpp>
#include <echinus/error.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <vector>

namespace echinus::wasm {

namespace {

// ---- Layouts

void add_layout(const DistanceMap& map, Lists& lists) {
    const DistanceMapView& view = map.view();
    lists.add(std::initializer_list<std::size_t>{
        static_cast<std::size_t>(view.grid), view.longitude_count, view.colatitude_count, view.divisions,
        static_cast<std::size_t>(view.pole_axis), static_cast<std::size_t>(view.entry_format),
        static_cast<std::size_t>(view.correction), view.centre_inside, view.direction_count(),
        view.entry_count()});
    lists.add(entry_histogram(view));
}

void add_layout(const ExactMap& map, Lists& lists) {
    const ExactMapView& view = map.view();
    lists.add(std::initializer_list<std::size_t>{view.divisions, static_cast<std::size_t>(view.rule),
                                                 view.border.empty(), view.cell_count(),
                                                 view.bands.size() - 1, view.references.size()});
}

// ---- Along a ray

/// @throws Error InvalidOptions
Vec3d unit_direction(double x, double y, double z) {
    const Vec3d direction{x, y, z};
    const double size = length(direction);
    if (!(size > 0) || !std::isfinite(size))
        throw Error(ErrorCode::InvalidOptions,
                    "the squared length of a ray's direction must be finite and greater than 0");
    return direction * (1 / size);
}

/// Adds an interval of a ray on which the answer does not change: from, to, inside, certain.
void add_interval(std::vector<double>& intervals, double from, double to, bool inside, bool certain = true) {
    intervals.insert(intervals.end(), {from, to, inside ? 1.0 : 0.0, certain ? 1.0 : 0.0});
}

/// Distances from the centre at which a ray crosses the faces that a cell lists, ascending.
std::vector<double> crossings_of(const ExactMapView& map, const BandRange& bands, const LatticePoint& along) {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t band = bands.first; band < bands.last; ++band)
        for (std::uint32_t r = map.bands[band].first_reference; r < map.bands[band + 1].first_reference; ++r)
            faces.push_back(map.references[r]);
    std::sort(faces.begin(), faces.end()); // a face is in the list of each band through which it passes
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

/// For each band: from, to, its faces, and the winding number towards the centre, NaN if it is not unique.
std::vector<double> bands_along(const ExactMapView& map, const BandRange& bands, double length_per_unit) {
    std::vector<double> result;
    for (std::uint32_t band = bands.first; band < bands.last; ++band) {
        const Band& b = map.bands[band];
        const int winding = map.winding_below[band];
        const bool known = winding != ExactMapView::kUncertain && winding != ExactMapView::kSplit;
        result.insert(result.end(),
                      {b.lower * length_per_unit, b.upper * length_per_unit,
                       static_cast<double>(map.bands[band + 1].first_reference - b.first_reference),
                       known ? winding : std::numeric_limits<double>::quiet_NaN()});
    }
    return result;
}

/// The side does not change between crossings, so each interval is classified at its middle.
std::vector<double> intervals_along(const ExactMapView& map, const std::vector<double>& crossings,
                                    const Vec3d& unit) {
    std::vector<double> result;
    double from = 0;
    const auto add = [&](double to) {
        if (!(to > from)) return;
        const Containment side = classify(map, Vec3f(Vec3d(map.centre) + unit * ((from + to) / 2)));
        add_interval(result, from, to, side.inside, side.certain);
        from = to;
    };
    for (const double distance : crossings) add(distance);
    add(double{map.radius});
    return result;
}

/// Appends the unit vectors to the three corners of a cell.
template <typename T>
void add_corners(const OctahedralCells& cells, std::uint32_t cell, std::vector<T>& corners) {
    for (const Vec3d& corner : cells.corners(cell)) {
        const Vec3d unit = corner * (1 / length(corner));
        for (const double c : {unit.x, unit.y, unit.z}) corners.push_back(static_cast<T>(c));
    }
}

void look_along(const ExactMapView& map, const Vec3d& unit, Lists& lists) {
    const LatticePoint along = lattice_direction(unit);
    const OctahedralCells cells(map.divisions);
    const std::uint32_t cell = cells.locate(along).cell;
    const BandRange bands = bands_of_cell(map, cell);
    const double l1_per_length = std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z);
    const double length_per_unit = ExactMapView::kBandUnit * frame_of(map).step / l1_per_length;
    const std::vector<double> crossings = crossings_of(map, bands, along);
    std::vector<double> corners;
    add_corners(cells, cell, corners);
    lists.add(std::initializer_list<std::uint32_t>{cell});
    lists.add(corners);
    lists.add(bands_along(map, bands, length_per_unit));
    lists.add(crossings);
    lists.add(intervals_along(map, crossings, unit));
}

/// The values that a query for a particle on this ray interpolates.
template <typename Grid>
void look_along(const DistanceMapView& map, const Grid& grid, const Vec3f& unit, Lists& lists) {
    const auto at = grid.coordinates_of(grid.to_grid(unit));
    const Interpolation<Grid> samples = interpolation_at(map, grid, grid.cell_at(at));
    std::vector<double> crossings, intervals;
    double from = 0;
    for (std::uint32_t k = 0; k <= samples.entry_count; ++k) {
        const bool last = k == samples.entry_count;
        const double to = last ? map.radius : Grid::distance_of(interpolated(map, samples, k), at);
        if (!last) crossings.push_back(to);
        if (to > from) add_interval(intervals, from, to, (k % 2 == 0) == map.centre_inside);
        from = std::max(from, to);
    }
    std::array<std::uint32_t, 4> entry_counts{};
    for (std::size_t corner = 0; corner < 4; ++corner)
        entry_counts[corner] = entry_count_of(map, samples.cell.corners[corner]);
    lists.add(samples.cell.corners);
    lists.add(entry_counts);
    lists.add(samples.usable);
    lists.add(crossings);
    lists.add(intervals);
}

void look_along(const DistanceMapView& map, const Vec3d& unit, Lists& lists) {
    with_grid(map, [&](const auto& grid) { look_along(map, grid, Vec3f(unit), lists); });
}

// ---- Cells

struct Cells {
    /// [cell_count] the number of bands, and of faces in all of their lists.
    std::vector<std::uint32_t> band_counts, face_counts;
    std::vector<float> corners; ///< [9 cell_count] unit vectors
};

Cells cells_of(const ExactMapView& map) {
    Cells result;
    const OctahedralCells cells(map.divisions);
    for (std::uint32_t cell = 0; cell < map.cell_count(); ++cell) {
        const BandRange bands = bands_of_cell(map, cell);
        result.band_counts.push_back(bands.last - bands.first);
        result.face_counts.push_back(map.bands[bands.last].first_reference -
                                     map.bands[bands.first].first_reference);
        add_corners(cells, cell, result.corners);
    }
    return result;
}

} // namespace

/// Those parts of a map's layout that echinus_map_describe() and the statistics do not contain.
ECHINUS_EXPORT(wasm_map_layout)
echinus_status wasm_map_layout(const echinus_map* map, echinus_array** layout) {
    return make(__func__, layout, [&] {
        Lists lists;
        with_map(map, [&](const auto& kind) { add_layout(kind, lists); });
        return lists.array();
    });
}

ECHINUS_EXPORT(wasm_map_ray)
echinus_status wasm_map_ray(const echinus_map* map, double x, double y, double z, echinus_array** ray) {
    return make(__func__, ray, [&] {
        const Vec3d unit = unit_direction(x, y, z);
        Lists lists;
        with_map(map, [&](const auto& kind) { look_along(kind.view(), unit, lists); });
        return lists.array();
    });
}

ECHINUS_EXPORT(wasm_map_cells)
echinus_status wasm_map_cells(const echinus_map* map, echinus_array** band_counts,
                              echinus_array** face_counts, echinus_array** corners) {
    return guarded(__func__, [&] {
        Cells cells = cells_of(exact_map_at(map).view());
        put_arrays({band_counts, face_counts, corners},
                   {array_of(std::move(cells.band_counts)), array_of(std::move(cells.face_counts)),
                    array_of(std::move(cells.corners))});
    });
}

/// @pre the map is a distance map
ECHINUS_EXPORT(wasm_map_usable_sample_count)
int wasm_map_usable_sample_count(const echinus_map* map, float x, float y, float z) {
    return usable_sample_count(std::get<DistanceMap>(map->value.kind).view(), {x, y, z});
}

} // namespace echinus::wasm
