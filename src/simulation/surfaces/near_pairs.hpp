#pragma once

#include "simulation/particles.hpp"
#include "simulation/surfaces/elements.hpp"
#include "simulation/surfaces/separation.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Elements whose vertices move simultaneously along straight paths.
struct MovingElements {
    const Elements& elements;
    const PointArrays &from, &to;
};

/// Appends the pairs of a vertex and a face or of two edges in these pairs of elements that may come as near
/// as `reach` on their paths. Each vertex and each edge is considered only in the element that owns it. Pairs
/// are excluded if their boxes are farther apart along an axis both at the start and, on the same side, at
/// the end, and pairs of one surface also if they share a vertex. The result has the same pairs in the same
/// order for every instruction set.
/// @param elements  the numbers of one element of `own` and one of `other`
void find_near_pairs(std::span<const std::array<std::uint32_t, 2>> elements, const MovingElements& own,
                     const MovingElements& other, float reach, std::vector<Pair>& pairs);

} // namespace echinus
