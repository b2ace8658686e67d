#pragma once

#include "simulation/surfaces/element_tree.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Appends the pairs of an element of `a` and one of `b` whose boxes are at most `reach` apart along each
/// axis. Where `a` and `b` are the same tree, each pair comes once, in either order, and none with itself.
void find_near(const ElementTree& a, const ElementTree& b, float reach,
               std::vector<std::array<std::uint32_t, 2>>& near);

/// The same for some elements that are given by their boxes: appends a pair of a box's number and an element
/// of the tree.
void find_near(std::span<const Box> boxes, const ElementTree& tree, float reach,
               std::vector<std::array<std::uint32_t, 2>>& near);

} // namespace echinus
