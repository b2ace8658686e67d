#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

/// The generalised winding number, computed by a tree of triangles: distant groups of them by their moments,
/// with error bounds (build/open_surface.hpp), near triangles one by one.
namespace echinus {

/// The purpose of a winding number, which determines the required accuracy.
struct WindingGoal {
    /// The values at which an answer changes.
    enum class Turn : std::uint8_t {
        AtOneHalf,   ///< for the side by InsideRule::Nonzero; at minus a half, too, for surfaces that are
                     ///< inside out
        AtEveryHalf, ///< for the side by InsideRule::Parity, and for the rounded number
    };

    Turn turn;
    double tolerance = std::numeric_limits<double>::infinity(); ///< the largest error of the number
};

/// The distance of a winding number from the nearest value at which the answer changes.
inline double distance_from_turn(double winding, WindingGoal::Turn turn) {
    const bool is_one_half = turn == WindingGoal::Turn::AtOneHalf;
    return std::fabs(is_one_half ? std::fabs(winding) - 0.5 : winding - std::floor(winding) - 0.5);
}

/// The winding number around a place, refined until its error is at most the tolerance and cannot change the
/// answer or whether that is certain. The bits are the same on every instruction set.
/// @param place      in lattice steps
/// @param on_lattice  the place, if it is a lattice point; on a face, its side is then decided exactly, as
///                    for all queries
/// @param crossings   for a tree of caps, the crossings of the place's ray with faces and caps beyond the
///                   place
/// @returns  nothing if rounding decides, because the winding number is near a turning point or the place
/// near an edge
/// @pre the map has a winding tree, and the place is finite
std::optional<double> decided_winding_by_tree(const ExactMapView& map, const Vec3d& place,
                                              const LatticePoint* on_lattice, int crossings,
                                              const WindingGoal& goal) noexcept;

} // namespace echinus
