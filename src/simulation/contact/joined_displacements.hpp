#pragma once

#include "mechanics/energy_term.hpp"
#include "simulation/contact/contact_side.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// The part of displacements that particles make together, so that no pair loses more than a share of its gap
/// by it. Particles of pairs that would run into each other on their own displacements make a common one:
/// that of one that is held among them; or of the model that they would run into; or else the mean by mass.
/// All others keep their own. Beside models that deform, no common displacement keeps all gaps: there the
/// particles of such pairs are moved apart just as far as is missing, pair by pair.
///
/// @param sides  where pairs are listed; out: `base` and `goal` in each side's frame, and the pairs that are
/// near on the way there, measured
/// @param joined  out: [particle] where each goes together with others: its goal where it is alone
void join_displacements(std::span<ContactSide> sides, Places safe, Places goals,
                        std::span<const double> masses, std::span<const std::uint8_t> is_held,
                        std::vector<Vec3d>& joined, const Workers& workers);

} // namespace echinus
