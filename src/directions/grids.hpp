#pragma once

#include "directions/cube_grid.hpp"
#include "directions/octahedral_grid.hpp"
#include "directions/spherical_grid.hpp"

#include <variant>

namespace echinus {

/// Every grid of directions. A new one needs a class in its own file with the members of these (samples,
/// cells and weights, the interpolated quantity, the gradient), an overload of for_each_sample_near(), a line
/// here, one in with_grid() (distance_map/layout.hpp) and a counterpart for vectors of particles
/// (distance_map/query/*_kernels.cpp). Builds and queries depend on no other properties of a grid.
using AnyGrid = std::variant<SphericalGrid, OctahedralGrid, CubeGrid, EllipsoidalGrid>;

} // namespace echinus
