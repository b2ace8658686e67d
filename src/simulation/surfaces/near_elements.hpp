#pragma once

#include "simulation/surfaces/element_tree.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Boxes around elements whose vertices move along straight ways, all together: where the ways begin, and
/// where they end.
struct MovingTree {
    ElementTree from, to;             ///< in the same groups
    std::vector<std::uint8_t> wanted; ///< [groups] one bit for each element that is looked at

    MovingTree() = default;
    MovingTree(std::span<const Element> elements, const PointArrays& positions)
        : from(elements, positions), to(from), wanted(from.group_count()) {}

    /// @param is_wanted  (element)
    template <typename IsWanted>
    void want(const IsWanted& is_wanted) {
        std::fill(wanted.begin(), wanted.end(), std::uint8_t{0});
        for (std::size_t i = 0; i < from.order().size(); ++i)
            if (is_wanted(from.order()[i]))
                wanted[i / ElementTree::kWidth] |= static_cast<std::uint8_t>(1U << (i % ElementTree::kWidth));
    }
    /// To wanted elements, whose ways have changed.
    void refit(std::span<const Element> elements, const PointArrays& at_start, const PointArrays& at_end) {
        from.refit(elements, at_start, wanted);
        to.refit(elements, at_end, wanted);
    }
};

/// Appends the pairs of a wanted element of `a` and any of `b` that may come as near as `reach` on their
/// ways. Those do not whose boxes are farther apart along an axis both at the start and, on the same side, at
/// the end: the distance along an axis is linear in time. So motion that two elements have in common does not
/// bring them together. Where `a` and `b` are the same tree, each pair comes once, in either order, and none
/// with itself.
void find_near(const MovingTree& a, const MovingTree& b, float reach,
               std::vector<std::array<std::uint32_t, 2>>& near);

} // namespace echinus
