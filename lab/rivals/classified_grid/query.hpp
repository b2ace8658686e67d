#pragma once

#include "rivals/classified_grid/layout.hpp"

#include <echinus/contact.hpp>

#include <optional>

/// The nearest point of the surface, one particle at a time. Places and lengths in lattice steps.
namespace echinus::rivals {

struct NearestPlace {
    Vec3d point;
    double distance = 0;
    std::uint32_t face = 0;
    Feature feature = Feature::Unknown;
};

/// Where the nearest point of a triangle to a place lies.
NearestPlace nearest_on_face(const GridArrays& grid, std::uint32_t face, const Vec3d& place);

/// The nearest point of the whole surface, if it is at most `farthest` away: bricks on the surface are looked
/// through in shells around the place until no nearer face can follow.
std::optional<NearestPlace> nearest_place(const GridArrays& grid, const Vec3d& place, double farthest);

/// The contact of a particle whose nearest point is known.
Contact contact_at(const GridArrays& grid, const Vec3f& point_local, bool inside,
                   const NearestPlace& nearest);

/// The whole answer for a particle that is inside or not.
Contact contact(const GridArrays& grid, const Vec3f& point_local, bool inside, float margin);

/// Is the snapped particle inside? Decided with exact integers.
bool is_inside(const GridArrays& grid, const Vec3f& point_local);

/// The exact change of the winding number by a face along the segment between two lattice points.
int crossing_between(const GridArrays& grid, std::uint32_t face, const LatticePoint& from,
                     const LatticePoint& to);

} // namespace echinus::rivals
