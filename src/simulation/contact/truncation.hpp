#pragma once

#include "simulation/contact/contact_side.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace echinus {

/// Lessens the shares of displacements from `base` to `goal`, beyond those from `safe` to `base`, so that no
/// pair closes more than its gap, whatever share each particle goes. Each of the two parts gets of the gap
/// what it asks for; one that is held gets all.
/// @param side    measured at `safe`
/// @param shares  [particle] in and out, 0 to 1
/// @return how many pairs touch at `safe`, cannot be told apart, so that their particles stay, or meet at
/// `base`
std::size_t limit_displacements(const ContactSide& side, std::span<const std::uint8_t> is_held,
                                std::span<float> shares);

} // namespace echinus
