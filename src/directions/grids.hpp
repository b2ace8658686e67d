#pragma once

#include "directions/cube_grid.hpp"
#include "directions/ellipsoidal_grid.hpp"
#include "directions/octahedral_grid.hpp"
#include "directions/spherical_grid.hpp"

#include <variant>

namespace echinus {

/// Every grid of directions. One is added by a class in a file of its own with the members of these (samples,
/// cells and weights, what is interpolated, the gradient), a for_each_sample_near() beside it, its line here,
/// one in with_grid() (distance_map/layout.hpp) and its counterpart for vectors of particles
/// (distance_map/*_lanes-inl.hpp). Builds and queries know nothing else of it.
using AnyGrid = std::variant<SphericalGrid, OctahedralGrid, CubeGrid, EllipsoidalGrid>;

} // namespace echinus
