// One particle at a time, exactly: what the kernels are compared with.

#include "rivals/classified_grid/query.hpp"

#include "exact_map/query/ray_crossing.hpp"
#include "geometry/triangle.hpp"
#include "rivals/classified_grid/classified_grid.hpp"
#include "rivals/classified_grid/layout.hpp"
#include "simd/dispatch.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace echinus::rivals {

namespace {

using Corners = TriangleCorners; ///< of a face, with the place as origin

Corners corners_around(const GridArrays& grid, std::uint32_t face, const Vec3d& place) {
    const auto corners = grid.face(face);
    return {Vec3d(corners[0]) - place, Vec3d(corners[1]) - place, Vec3d(corners[2]) - place};
}

/// Distance of a place from a box.
double distance_to_box(const Vec3d& place, const Vec3d& low, const Vec3d& high) {
    const auto outside = [](double p, double l, double h) { return std::max({l - p, p - h, 0.0}); };
    return length(Vec3d{outside(place.x, low.x, high.x), outside(place.y, low.y, high.y),
                        outside(place.z, low.z, high.z)});
}

/// Looks through the cells of a grid for faces near a place.
class Search {
  public:
    Search(const GridArrays& grid, const Vec3d& place) : grid_(grid), place_(place) {}

    /// Calls visit(face) for the faces of each cell on the surface in a brick that lies within reach(). Faces
    /// may come several times.
    template <typename Reach, typename Visit>
    void look_through(const CellPlace& brick_place, const Reach& reach, const Visit& visit) const {
        const Brick& brick = grid_.bricks[grid_.brick_numbers[grid_.frame.brick_at(brick_place)]];
        const CellPlace first{4 * brick_place.x, 4 * brick_place.y, 4 * brick_place.z};
        if (distance_to(first, Brick::kEdge) > reach()) return;
        for (std::uint32_t i = 0; i < 64; ++i) {
            if (!(state_of(brick, i) & kSurfaceBit)) continue;
            const auto offset = static_cast<std::int32_t>(i);
            const CellPlace cell{first.x + (offset & 3), first.y + (offset >> 2 & 3),
                                 first.z + (offset >> 4)};
            if (distance_to(cell, 1) > reach()) continue;
            const CellList list = list_of(grid_, brick, i);
            for (std::uint32_t r = list.first; r < list.last; ++r) visit(grid_.references[r]);
        }
    }

    /// Bricks [first, last] that meet the box around the place with a half edge of `reach`.
    std::array<CellPlace, 2> bricks_within(double reach) const {
        const auto brick = [&](double at, std::int32_t origin, std::int32_t count) {
            const double b = std::floor((at - origin) / (Brick::kEdge * double(grid_.frame.cell_steps)));
            return static_cast<std::int32_t>(std::clamp(b, 0.0, count - 1.0));
        };
        const auto& counts = grid_.frame.brick_counts;
        const auto& origin = grid_.frame.origin;
        const auto corner = [&](double step) {
            return CellPlace{brick(place_.x + step, origin.x, counts[0]),
                             brick(place_.y + step, origin.y, counts[1]),
                             brick(place_.z + step, origin.z, counts[2])};
        };
        return {corner(-reach), corner(reach)};
    }
    bool is_stored(const CellPlace& brick) const {
        return grid_.brick_numbers[grid_.frame.brick_at(brick)] > GridArrays::kInside;
    }

  private:
    double distance_to(const CellPlace& cell, std::int32_t edge) const {
        const double size = grid_.frame.cell_steps;
        const Vec3d low = Vec3d(grid_.frame.origin) + Vec3d(cell) * size;
        const double length = size * edge;
        return distance_to_box(place_, low, low + Vec3d{length, length, length});
    }

    const GridArrays& grid_;
    Vec3d place_;
};

/// Unit normal of a face, 0 of one without area.
Vec3d unit_normal(const GridArrays& grid, std::uint32_t face) {
    const auto [a, b, c] = grid.face(face);
    const Vec3d normal(cross(b - a, c - a));
    const double area = length(normal);
    return area > 0 ? normal * (1 / area) : Vec3d{};
}

/// Two snapped positions differ from the true ones by at most sqrt(3) lattice steps together.
constexpr double kSnapping = 2;

/// Angle-weighted normal of the faces around a point of the surface (Baerentzen and Aanaes, "Signed distance
/// computation using the angle weighted pseudonormal", 2005).
Vec3d pseudonormal(const GridArrays& grid, const NearestPlace& nearest) {
    const Search search(grid, nearest.point);
    std::vector<std::uint32_t> faces;
    const auto [first, last] = search.bricks_within(kSnapping);
    for (std::int32_t z = first.z; z <= last.z; ++z)
        for (std::int32_t y = first.y; y <= last.y; ++y)
            for (std::int32_t x = first.x; x <= last.x; ++x)
                search.look_through(
                    {x, y, z}, [] { return kSnapping; }, [&](std::uint32_t face) { faces.push_back(face); });
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    Vec3d sum;
    for (const std::uint32_t face : faces)
        if (nearest_on_face(grid, face, nearest.point).distance <= kSnapping)
            sum += unit_normal(grid, face) *
                   double{spanned_angle(corners_around(grid, face, nearest.point), kSnapping)};
    constexpr double kCancelled = 1e-6;
    if (length(sum) < kCancelled) sum = unit_normal(grid, nearest.face);
    const double l = length(sum);
    return l > 0 ? sum * (1 / l) : Vec3d{0, 0, 1};
}

bool is_inside_at(const GridArrays& grid, const Vec3d& place) {
    return is_inside(grid, Vec3f(grid.frame.lattice.to_local(place)));
}

/// Faces may be turned the other way.
Vec3f out_of_solid(const GridArrays& grid, const Vec3d& point, const Vec3d& normal) {
    const Vec3d clear = normal * (2 * kSnapping);
    const bool inwards = is_inside_at(grid, point + clear) && !is_inside_at(grid, point - clear);
    return Vec3f(inwards ? -normal : normal);
}

} // namespace

NearestPlace nearest_on_face(const GridArrays& grid, std::uint32_t face, const Vec3d& place) {
    const auto [offset, distance, feature] = nearest_on_triangle(corners_around(grid, face, place));
    NearestPlace nearest;
    nearest.point = offset + place;
    nearest.distance = distance;
    nearest.feature = feature;
    nearest.face = face;
    return nearest;
}

std::optional<NearestPlace> nearest_place(const GridArrays& grid, const Vec3d& place, double farthest) {
    const Search search(grid, place);
    NearestPlace best;
    best.distance = std::numeric_limits<double>::infinity();
    const auto reach = [&] { return std::min(best.distance, farthest); };
    const auto visit = [&](std::uint32_t face) {
        const NearestPlace nearest = nearest_on_face(grid, face, place);
        const bool first_of_equals = nearest.distance == best.distance && nearest.face < best.face;
        if (nearest.distance < best.distance || first_of_equals) best = nearest;
    };
    // Boxes of bricks around the place that grow by one brick; of each only what is new.
    const double brick_edge = Brick::kEdge * double(grid.frame.cell_steps);
    const auto& counts = grid.frame.brick_counts;
    auto [low, high] = search.bricks_within(0);
    CellPlace done_low = low, done_high = low - CellPlace{1, 1, 1};
    for (double covered = 0;; covered += brick_edge) {
        for (std::int32_t z = low.z; z <= high.z; ++z)
            for (std::int32_t y = low.y; y <= high.y; ++y)
                for (std::int32_t x = low.x; x <= high.x; ++x) {
                    const bool done = x >= done_low.x && x <= done_high.x && y >= done_low.y &&
                                      y <= done_high.y && z >= done_low.z && z <= done_high.z;
                    if (!done && search.is_stored({x, y, z})) search.look_through({x, y, z}, reach, visit);
                }
        // Faces beyond the box are farther away than its extent around the place.
        const bool everything =
            low == CellPlace{} && high == CellPlace{counts[0] - 1, counts[1] - 1, counts[2] - 1};
        if (everything || reach() <= covered) break;
        done_low = low;
        done_high = high;
        low = {std::max(low.x - 1, 0), std::max(low.y - 1, 0), std::max(low.z - 1, 0)};
        high = {std::min(high.x + 1, counts[0] - 1), std::min(high.y + 1, counts[1] - 1),
                std::min(high.z + 1, counts[2] - 1)};
    }
    if (!(best.distance <= farthest)) return std::nullopt;
    return best;
}

Contact contact_at(const GridArrays& grid, const Vec3f& point_local, bool inside,
                   const NearestPlace& nearest) {
    const Vec3d place = grid.frame.lattice.to_lattice(point_local);
    const Vec3d offset = nearest.point - place;
    Contact contact;
    contact.inside = inside;
    contact.point = Vec3f(grid.frame.lattice.to_local(nearest.point));
    contact.depth = static_cast<float>((inside ? 1 : -1) * nearest.distance * grid.frame.lattice.step);
    contact.normal = nearest.distance <= kSnapping
                         ? out_of_solid(grid, nearest.point, pseudonormal(grid, nearest))
                         : Vec3f(offset * ((inside ? 1 : -1) / nearest.distance));
    contact.face = nearest.face;
    contact.feature = nearest.feature;
    return contact;
}

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
