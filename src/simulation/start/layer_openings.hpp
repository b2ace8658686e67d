#pragma once

#include "simulation/start/openings.hpp"
#include "simulation/surfaces/elements.hpp"

#include <echinus/geometry.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace echinus {

/// Adds the gaps to be opened so that layers that intersect move to one side of each other.
///
/// If the curve along which they intersect cuts a layer into two pieces, the smaller piece has come through
/// the other layer and moves back (global intersection analysis: Baraff, Witkin and Kass 2003, section 4).
/// Otherwise the curve ends at a border, and the edges that cross there move such that it becomes shorter
/// (Volino and Magnenat-Thalmann 2006, section 3).
/// @param gap  the distance to be opened
/// @param edge_length  the mean edge length of the surface
/// @return the number of intersecting pairs
std::size_t add_layer_openings(const Elements& elements, std::span<const Vec3f> positions, float gap,
                               float edge_length, std::vector<Opening>& openings);

} // namespace echinus
