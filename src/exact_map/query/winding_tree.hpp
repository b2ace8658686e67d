#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

/// The generalised winding number by the face tree: groups of faces far away by their moments, with bounds
/// (winding_nodes.hpp), the faces nearby one by one.
namespace echinus {

/// With a border of no more edges the sum over them (border_part.hpp) takes less time.
inline constexpr std::size_t kFewBorderEdges = 16;

/// The winding number around a place, refined until its error is neither more than the tolerance nor enough
/// to change the side or whether that is certain. The same bits under every instruction set.
/// @param place      in lattice steps
/// @param on_lattice the place, if it is a point of the lattice: on a face its side is then decided exactly,
///                   as it is for all queries
/// @returns  nothing where rounding decides; so near to a turning point, or to an edge
/// @pre the map has winding nodes, and the place is finite
std::optional<double> decided_winding_by_tree(const ExactMapView& map, const Vec3d& place,
                                              const LatticePoint* on_lattice, double tolerance) noexcept;

} // namespace echinus
