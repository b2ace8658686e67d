#pragma once

#include "simulation/particles.hpp"

#include <echinus/simulation.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// A stick as its relaxation needs it.
struct JakobsenStick {
    std::uint32_t a, b;
    float rest_length;
    float share_a, share_b; ///< of its error, by the masses and the stiffness
};

/// In the deformable's order, without those between two pinned particles.
std::vector<JakobsenStick> jakobsen_sticks(const Deformable& deformable,
                                           const std::array<double, kStickKindCount>& stiffness);

/// One relaxation of all sticks, one after the other.
void relax(std::span<const JakobsenStick> sticks, PointArrays& positions) noexcept;

} // namespace echinus
