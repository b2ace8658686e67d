// One particle at a time, exactly: what the kernels are compared with.

#include "exact_map/query/ray_crossing.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/classified_grid/layout.hpp"
#include "rivals/classified_grid/nearest.hpp"
#include "simd/dispatch.hpp"

#include <cassert>

namespace echinus::rivals {

int crossing_between(const GridArrays& grid, std::uint32_t face, const LatticePoint& from,
                     const LatticePoint& to) {
    const auto crossing = crossing_with_face(grid.face(face), from, to);
    return !crossing ? 0 : crossing->entering() ? 1 : -1;
}

bool is_inside(const GridArrays& grid, const Vec3f& point_local) {
    const Vec3f in_cells = grid.frame.in_cells(point_local);
    if (!grid.frame.is_within(in_cells)) return false;
    const CellPlace cell = cell_at(in_cells);
    const Brick& brick = grid.brick(cell);
    const std::uint32_t in_brick = cell_in_brick(cell);
    const std::uint32_t state = state_of(brick, in_brick);
    if (!(state & kSurfaceBit)) return state != 0;
    const CellList list = list_of(grid, brick, in_brick);
    const LatticePoint centre(grid.frame.centre_of(cell));
    const LatticePoint particle = rounded(grid.frame.lattice.to_lattice(point_local));
    int winding = winding_of_centre(grid, list.number, state);
    for (std::uint32_t r = list.first; r < list.last; ++r)
        winding += crossing_between(grid, grid.references[r], centre, particle);
    return winding != 0;
}

bool ClassifiedGrid::contains(const Vec3f& point_local) const noexcept {
    return is_inside(*arrays_, point_local);
}

Contact contact(const GridArrays& grid, const Vec3f& point_local, bool inside, float margin) {
    Contact none;
    none.point = point_local;
    if (!is_finite(point_local) || (!inside && !(margin > 0))) return none;
    const LatticeFrame& lattice = grid.frame.lattice;
    constexpr double kEverything = 4 * static_cast<double>(kLatticeExtent);
    const double farthest = inside ? kEverything : double{margin} * lattice.inverse_step;
    const auto nearest = nearest_place(grid, lattice.to_lattice(point_local), farthest);
    return nearest ? contact_at(grid, point_local, inside, *nearest) : none;
}

Contact ClassifiedGrid::contact(const Vec3f& point_local, float margin) const noexcept {
    return rivals::contact(*arrays_, point_local, is_inside(*arrays_, point_local), margin);
}

void ClassifiedGrid::contains_batch(std::span<const Vec3f> points_local,
                                    std::span<std::uint8_t> inside) const {
    assert(points_local.size() == inside.size());
    if (use_kernels()) return contains_kernel(*arrays_, points_local, inside);
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = contains(points_local[i]) ? 1 : 0;
}

void ClassifiedGrid::contacts_batch(std::span<const Vec3f> points_local, float margin,
                                    std::span<Contact> contacts) const {
    assert(points_local.size() == contacts.size());
    if (use_kernels()) return contacts_kernel(*arrays_, points_local, margin, contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i] = contact(points_local[i], margin);
}

} // namespace echinus::rivals
