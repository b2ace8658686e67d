// Collision detection with a distance map: paper section 2.2, clause by clause. This scalar code is the
// specification.
//
// The paper's symbols: p is the particle, C and R are the centre and radius of the bounding sphere, d = p -
// C, (phi_d, theta_d) are its angles, and S is an interpolated distance.

#include "distance_map/interpolation.hpp"
#include "distance_map/query/grid_kernels.hpp"
#include "geometry/parallel.hpp"
#include "geometry/precondition.hpp"
#include "simd/dispatch.hpp"

#include <echinus/distance_map.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace echinus {

namespace {

GridKernels kernels_of(DirectionGrid grid) noexcept {
    switch (grid) {
    case DirectionGrid::Ellipsoidal:
        return ellipsoidal_kernels();
    case DirectionGrid::Octahedral:
        return octahedral_kernels();
    case DirectionGrid::Cube:
        return cube_kernels();
    default:
        return spherical_kernels();
    }
}

/// Can the kernels read this map? Not if it is too small to be worthwhile or its arrays are too large for
/// 32-bit indices.
bool kernels_read(const DistanceMapView& map) noexcept {
    constexpr std::size_t kMinEntries = 4; // a row
    constexpr std::size_t kMaxEntries = std::size_t{1}
                                        << 30; // offsets in bytes of 16-bit entries have 31 bits
    return map.entry_count() >= kMinEntries && map.entry_count() < kMaxEntries;
}

/// @pre kernels_read(map), use_kernels()
void contains_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        std::span<std::uint8_t> inside) noexcept {
    kernels_of(map.grid).contains(map, points_local, inside.data());
}

/// @pre as above; margin >= 0
void contacts_by_kernel(const DistanceMapView& map, const StridedSpan<const Vec3f>& points_local,
                        float margin, std::span<Contact> contacts) noexcept {
    kernels_of(map.grid).contacts(map, points_local, margin, contacts.data());
}

/// The ray from the centre to a particle.
template <typename Grid>
struct Ray {
    Vec3f along;  ///< d in the grid's frame, lengthened if it is very short: only its direction matters
    float length; ///< |d|
    typename Grid::Coordinates at; ///< (phi_d, theta_d)
};

template <typename Grid>
Ray<Grid> ray_to(const DistanceMapView& map, const Grid& grid, const Vec3f& point_local) {
    const Vec3f d = grid.to_grid(point_local - map.centre);
    const float d_length = length(d);
    const Vec3f along = d * (d_length < kShortRay ? kRayLengthening : 1);
    return {along, d_length, grid.coordinates_of(along)};
}

/// "Particle p is initially tested against the bounding sphere. If the particle does not penetrate the sphere
/// then no collision is reported." Also false for NaN and infinity, since neither compares below R.
bool reaches_sphere(const DistanceMapView& map, float d_length, float margin) {
    return d_length <= map.radius + margin;
}

/// The interval of a particle along its ray.
struct Interval {
    std::uint32_t number;
    float below, above; ///< its limits; the centre or the bounding sphere if there is no entry
};

/// "It is then enough to enumerate the intervals (starting from 0), find the interval where |d| lies": the
/// interval's number is the number of distances that |d| has reached. A particle on the map's surface belongs
/// to the outer interval.
template <typename Grid>
Interval interval_of(const DistanceMapView& map, const Interpolation<Grid>& at, const Ray<Grid>& ray) {
    Interval interval{0, 0, map.radius};
    for (; interval.number < at.entry_count; ++interval.number) {
        const float distance = Grid::distance_of(interpolated(map, at, interval.number), ray.at);
        if (distance > ray.length) {
            interval.above = distance;
            break;
        }
        interval.below = distance;
    }
    return interval;
}

/// "If |d| is on an even interval then p penetrates A" if the centre is inside; "in the other case, |d|
/// should be on an odd interval".
bool is_inside(const DistanceMapView& map, std::uint32_t interval) {
    return (interval % 2 == 0) == map.centre_inside;
}

/// A limit of the particle's interval: the k-th entry, or the bounding sphere if k is the number of entries.
struct IntervalEnd {
    std::uint32_t k;
    float distance;
};

/// "the interpolated distance value closer to |d|": one of the two limits of the interval. The centre is not
/// a limit, and the bounding sphere is one only if the solid reaches it, through a hole of an open mesh.
std::optional<IntervalEnd> nearest_end(const DistanceMapView& map, std::uint32_t entry_count,
                                       const Interval& interval, float d_length) {
    const IntervalEnd below{interval.number - 1, interval.below};
    const IntervalEnd above{interval.number, interval.above};
    const bool has_below = interval.number > 0;
    const bool has_above = interval.number < entry_count || is_inside(map, interval.number);
    if (has_below && has_above) return d_length - below.distance < above.distance - d_length ? below : above;
    if (has_below) return below;
    if (has_above) return above;
    return std::nullopt;
}

/// The unit vector along d; for the centre itself the direction of longitude 0, colatitude 0.
Vec3f direction_of(const Vec3f& along) {
    const float l = length(along);
    return l > 0 ? along * (1 / l) : Vec3f{0, 0, 1};
}

/// The unit normal of the map's surface, pointing out of the solid: along the gradient where the ray leaves
/// the solid, against it where the ray enters. The paper has no normals, but without one a solver has neither
/// a contact plane nor a direction of friction.
template <typename Grid>
Vec3f surface_normal(const DistanceMapView& map, const Grid& grid, const Interpolation<Grid>& at,
                     const Vec3f& e_r, const IntervalEnd& end) {
    if (end.k == at.entry_count) return grid.from_grid(e_r); // the bounding sphere
    const float value = interpolated(map, at, end.k);
    const Slope slope = slope_of_entry(map, at, end.k, value);
    const Vec3f gradient =
        grid.surface_gradient(e_r, at.cell, end.distance, value, slope.along_u, slope.along_v);
    const float steepness = length(gradient); // infinite if its square leaves the range of float
    const Vec3f unit = std::isfinite(steepness) ? gradient * (1 / steepness) : e_r;
    return grid.from_grid(is_outward(map.centre_inside, end.k) ? unit : -unit);
}

Contact no_contact(const Vec3f& point_local) {
    Contact contact;
    contact.point = point_local;
    return contact;
}

template <typename Grid>
bool contains(const DistanceMapView& map, const Grid& grid, const Vec3f& point_local) {
    const Ray<Grid> ray = ray_to(map, grid, point_local);
    if (!reaches_sphere(map, ray.length, 0)) return false;
    const Interpolation<Grid> at = interpolation_at(map, grid, grid.cell_at(ray.at));
    return is_inside(map, interval_of(map, at, ray).number);
}

/// @pre margin >= 0
template <typename Grid>
Contact contact(const DistanceMapView& map, const Grid& grid, const Vec3f& point_local, float margin) {
    Contact result = no_contact(point_local);
    const Ray<Grid> ray = ray_to(map, grid, point_local);
    if (!(reaches_sphere(map, ray.length, margin) && std::isfinite(ray.length))) return result;

    const Interpolation<Grid> at = interpolation_at(map, grid, grid.cell_at(ray.at));
    const Interval interval = interval_of(map, at, ray);
    const std::optional<IntervalEnd> end = nearest_end(map, at.entry_count, interval, ray.length);
    if (!end) return result;
    const bool inside = ray.length <= map.radius && is_inside(map, interval.number);
    const float distance = std::fabs(end->distance - ray.length);
    if (!inside && !(distance <= margin)) return result;

    const Vec3f e_r = direction_of(ray.along);
    result.inside = inside;
    result.normal = surface_normal(map, grid, at, e_r, *end);
    // "in order for p to exit from A, it should translate S - |d| distance along the direction of d"
    result.point = map.centre + grid.from_grid(e_r) * end->distance;
    result.depth = inside ? distance : -distance;
    return result;
}

/// With NaN or a negative margin, only particles inside have contacts.
float usable_margin(float margin) {
    return margin > 0 ? margin : 0;
}

} // namespace

bool contains(const DistanceMapView& map, Vec3f point_local) noexcept {
    return with_grid(map, [&](const auto& grid) { return contains(map, grid, point_local); });
}

Contact contact(const DistanceMapView& map, Vec3f point_local, float margin) noexcept {
    return with_grid(
        map, [&](const auto& grid) { return contact(map, grid, point_local, usable_margin(margin)); });
}

void contains_batch(const DistanceMapView& map, StridedSpan<const Vec3f> points_local,
                    std::span<std::uint8_t> inside, unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == inside.size(),
                "contains_batch: the number of answers differs from the number of points"))
        return;
    const bool by_kernel = use_kernels() && kernels_read(map);
    for_each_piece(inside.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        const std::size_t size = end - begin;
        if (by_kernel)
            return contains_by_kernel(map, points_local.subspan(begin, size), inside.subspan(begin, size));
        for (std::size_t i = begin; i < end; ++i) inside[i] = contains(map, points_local[i]) ? 1 : 0;
    });
}

void contacts_batch(const DistanceMapView& map, StridedSpan<const Vec3f> points_local, float margin,
                    std::span<Contact> contacts, unsigned thread_count) noexcept {
    if (!is_met(points_local.size() == contacts.size(),
                "contacts_batch: the number of contacts differs from the number of points"))
        return;
    const bool by_kernel = use_kernels() && kernels_read(map);
    for_each_piece(contacts.size(), thread_count, [&](std::size_t begin, std::size_t end) {
        const std::size_t size = end - begin;
        if (by_kernel)
            return contacts_by_kernel(map, points_local.subspan(begin, size), usable_margin(margin),
                                      contacts.subspan(begin, size));
        for (std::size_t i = begin; i < end; ++i) contacts[i] = contact(map, points_local[i], margin);
    });
}

int usable_sample_count(const DistanceMapView& map, Vec3f point_local) noexcept {
    return with_grid(map, [&]<typename Grid>(const Grid& grid) {
        const Ray<Grid> ray = ray_to(map, grid, point_local);
        if (!reaches_sphere(map, ray.length, 0)) return 0;
        const Interpolation<Grid> at = interpolation_at(map, grid, grid.cell_at(ray.at));
        int count = 0;
        for (std::size_t corner = 0; corner < 4; ++corner)
            if (at.usable[corner] && Grid::is_sample(at.cell, corner)) ++count;
        return count;
    });
}

} // namespace echinus
