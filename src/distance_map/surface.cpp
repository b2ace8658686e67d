// The surface that a map describes, for pictures: the paper's figures 2 and 3.

#include "distance_map/layout.hpp"

#include <array>
#include <utility>

namespace echinus {

namespace {

/// The corners of one cell, around: (i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j). With theta running down
/// from the pole and phi counter-clockwise, this is counter-clockwise seen from outside the sphere.
using CellCorners = std::array<std::uint32_t, 4>;

bool have_equal_counts(const DistanceMapView& map, const CellCorners& corners) {
    const std::uint32_t count = entry_count_of(map, corners[0]);
    return count == entry_count_of(map, corners[1]) && count == entry_count_of(map, corners[2]) &&
           count == entry_count_of(map, corners[3]);
}

/// One vertex per entry, at the entry's position in the entry arrays.
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

/// One face of layer k between three directions that are counter-clockwise seen from outside the sphere.
void add_face(const DistanceMapView& map, const Triangle& directions, std::uint32_t k, MapSurface& surface) {
    Triangle face;
    for (std::size_t c = 0; c < 3; ++c) face[c] = map.entry_offsets[directions[c]] + k;
    if (!is_outward(map.centre_inside, k)) std::swap(face[1], face[2]);
    surface.mesh.faces.push_back(face);
    surface.layer.push_back(k);
}

void add_cell(const DistanceMapView& map, const CellCorners& q, MapSurface& surface) {
    if (!have_equal_counts(map, q)) return;
    for (std::uint32_t k = 0; k < entry_count_of(map, q[0]); ++k) {
        add_face(map, {q[0], q[1], q[2]}, k, surface);
        add_face(map, {q[0], q[2], q[3]}, k, surface);
    }
}

/// The grid leaves a small polygon open around each pole; a fan fills it where its samples have equal counts.
void add_pole(const DistanceMapView& map, const SphericalGrid& grid, std::uint32_t j, MapSurface& surface) {
    const std::uint32_t last = grid.longitude_count() - 1;
    const std::uint32_t hub = grid.index(0, j);
    for (std::uint32_t i = 0; i <= last; ++i)
        if (entry_count_of(map, grid.index(i, j)) != entry_count_of(map, hub)) return;
    for (std::uint32_t i = 1; i < last; ++i) {
        std::uint32_t second = grid.index(i, j);
        std::uint32_t third = grid.index(i + 1, j);
        if (j != 0)
            std::swap(second, third); // seen from outside, longitude runs clockwise around the other pole
        for (std::uint32_t k = 0; k < entry_count_of(map, hub); ++k)
            add_face(map, {hub, second, third}, k, surface);
    }
}

void add_layers(const DistanceMapView& map, const SphericalGrid& grid, MapSurface& surface) {
    for (std::uint32_t j = 0; j + 1 < grid.colatitude_count(); ++j)
        for (std::uint32_t i = 0; i < grid.longitude_count(); ++i) {
            const std::uint32_t next = i + 1 == grid.longitude_count() ? 0 : i + 1;
            add_cell(map,
                     {grid.index(i, j), grid.index(i, j + 1), grid.index(next, j + 1), grid.index(next, j)},
                     surface);
        }
    add_pole(map, grid, 0, surface);
    add_pole(map, grid, grid.colatitude_count() - 1, surface);
}

/// The layers of one small triangle, whose corners are counter-clockwise seen from outside.
void add_triangle(const DistanceMapView& map, const Triangle& corners, MapSurface& surface) {
    const std::uint32_t count = entry_count_of(map, corners[0]);
    if (entry_count_of(map, corners[1]) != count || entry_count_of(map, corners[2]) != count) return;
    for (std::uint32_t k = 0; k < count; ++k) add_face(map, corners, k, surface);
}

/// Unfolding keeps the sense of rotation, so that what turns counter-clockwise in the square does so seen
/// from outside. Samples that appear more than once are one vertex, which closes the square's border.
void add_layers(const DistanceMapView& map, const OctahedralGrid& grid, MapSurface& surface) {
    const std::uint32_t n = grid.divisions();
    for (std::uint32_t j = 0; j < 2 * n; ++j)
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const std::array<std::uint32_t, 4> q{grid.canonical(i, j), grid.canonical(i + 1, j),
                                                 grid.canonical(i + 1, j + 1), grid.canonical(i, j + 1)};
            const std::size_t turn = (i >= n) != (j >= n) ? 1 : 0; // the way the diagonal runs
            add_triangle(map, {q[turn], q[turn + 1], q[(turn + 3) % 4]}, surface);
            add_triangle(map, {q[turn + 1], q[(turn + 2) % 4], q[(turn + 3) % 4]}, surface);
        }
}

} // namespace

MapSurface reconstruct_surface(const DistanceMapView& map) {
    return with_grid(map, [&](const auto& grid) {
        MapSurface surface;
        surface.mesh.vertices = entry_points(map, grid);
        add_layers(map, grid, surface);
        return surface;
    });
}

} // namespace echinus
