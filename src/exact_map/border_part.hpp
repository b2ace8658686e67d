#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

#include <span>

/// How the border of an open surface affects winding numbers.
///
/// Close the surface with a cone: a triangle from each border edge to the origin of the lattice. The rays
/// from the origin see that cone edge-on and never cross it, so the signed crossings of a particle's ray
/// beyond the particle are the winding number of the closed whole, an integer. The generalised winding number
/// of the surface alone (Jacobson et al. 2013) is that integer less the cone's part:
///
///     w(p) = crossings_beyond(p) + border_part(p),  border_part = - sum of solid angles of the cone / 4 pi.
///
/// The build and, where rounding leaves their answer open, queries sum this; other queries sum caps of the
/// border (build/border_caps.hpp), most of which are far away as seen from most places.
namespace echinus {

/// The border's contribution to the generalised winding number, beside the signed crossings beyond the place
/// share * d. A place on the cone counts as displaced by (e, e^2, e^3), as everywhere.
double border_part(std::span<const BorderEdge> border, std::span<const Vec3<std::int32_t>> vertices,
                   const LatticePoint& d, double share = 1);

} // namespace echinus
