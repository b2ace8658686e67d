#pragma once

#include "geometry/workers.hpp"
#include "simulation/surfaces/element_tree.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// Boxes around elements whose vertices move simultaneously along straight paths: at the beginning and at the
/// end of the paths.
struct MovingTree {
    ElementTree from, to;             ///< with the same groups
    std::vector<std::uint8_t> wanted; ///< [groups] one bit for each element that is examined

    MovingTree() = default;
    MovingTree(std::span<const Element> elements, const PointArrays& positions)
        : from(elements, positions), to(from), wanted(from.group_count()) {}

    /// @param is_wanted  (element)
    template <typename IsWanted>
    void want(const IsWanted& is_wanted, const Workers& workers) {
        workers.for_ranges(wanted.size(), kGroupsPerPiece,
                           [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                               for (std::size_t group = begin; group < end; ++group)
                                   wanted[group] = wanted_of(group, is_wanted);
                           });
    }
    /// Fits the boxes to the wanted elements, whose paths have changed.
    void refit(std::span<const Element> elements, const PointArrays& at_start, const PointArrays& at_end,
               const Workers& workers) {
        from.refit(elements, at_start, wanted, workers);
        to.refit(elements, at_end, wanted, workers);
    }
    std::size_t piece_count() const { return Workers::piece_count(wanted.size(), kGroupsPerPiece); }

    static constexpr std::size_t kGroupsPerPiece = 32;

  private:
    template <typename IsWanted>
    std::uint8_t wanted_of(std::size_t group, const IsWanted& is_wanted) const {
        const std::size_t first = group * ElementTree::kWidth;
        const std::size_t count = std::min(ElementTree::kWidth, from.order().size() - first);
        unsigned mask = 0;
        for (std::size_t k = 0; k < count; ++k)
            if (is_wanted(from.order()[first + k])) mask |= 1U << k;
        return static_cast<std::uint8_t>(mask);
    }
};

/// Appends the pairs of a wanted element of `a` and any element of `b` that may come as near as `reach` on
/// their paths. Pairs are excluded if their boxes are farther apart along an axis both at the start and, on
/// the same side, at the end: the distance along an axis is linear in time. So a motion that two elements
/// have in common does not bring them together. If `a` and `b` are the same tree, each pair occurs once, in
/// either order, and no element is paired with itself.
/// @param piece  of the groups of `a`, below a.piece_count()
void find_near(const MovingTree& a, const MovingTree& b, float reach, std::size_t piece,
               std::vector<std::array<std::uint32_t, 2>>& near);

} // namespace echinus
