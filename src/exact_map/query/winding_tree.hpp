#pragma once

#include "directions/lattice.hpp"

#include <echinus/exact_map_view.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

/// The generalised winding number by a tree of triangles: groups of them far away by their moments, with
/// bounds (build/open_surface.hpp), the triangles nearby one by one.
namespace echinus {

/// The purpose of a winding number, which determines the required accuracy.
struct WindingGoal {
    /// The values at which an answer turns.
    enum class Turn : std::uint8_t {
        AtOneHalf,   ///< that of a side by InsideRule::Nonzero, also for surfaces inside out: at minus a half
        AtEveryHalf, ///< that of a side by InsideRule::Parity, and the number rounded
    };

    Turn turn;
    double tolerance = std::numeric_limits<double>::infinity(); ///< of the number
};

/// How far a winding number is from the next value at which the answer turns.
inline double distance_from_turn(double winding, WindingGoal::Turn turn) {
    const bool is_one_half = turn == WindingGoal::Turn::AtOneHalf;
    return std::fabs(is_one_half ? std::fabs(winding) - 0.5 : winding - std::floor(winding) - 0.5);
}

/// The winding number around a place, refined until its error is neither more than the tolerance nor enough
/// to change the answer or whether that is certain. The same bits under every instruction set.
/// @param place      in lattice steps
/// @param on_lattice the place, if it is a point of the lattice: on a face its side is then decided exactly,
///                   as it is for all queries
/// @param crossings  beside caps: of the place's ray with faces and caps, beyond the place
/// @returns  nothing where rounding decides; so near to a turn, or to an edge
/// @pre the map has a winding tree, and the place is finite
std::optional<double> decided_winding_by_tree(const ExactMapView& map, const Vec3d& place,
                                              const LatticePoint* on_lattice, int crossings,
                                              const WindingGoal& goal) noexcept;

} // namespace echinus
