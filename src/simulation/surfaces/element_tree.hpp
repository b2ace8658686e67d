#pragma once

#include "geometry/workers.hpp"
#include "simulation/particles.hpp"
#include "simulation/surfaces/elements.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echinus {

/// An axis-aligned box.
struct Box {
    std::array<float, 3> low, high;

    void grow(float by) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] -= by;
            high[axis] += by;
        }
    }
};

Box box_of(const Element& element, const PointArrays& positions);

/// Boxes around the elements of a surface, around groups of eight, around groups of eight groups, and so on.
/// The groups are fixed from the start; the boxes follow the surface.
class ElementTree {
  public:
    static constexpr std::size_t kWidth = 8;

    ElementTree() = default;
    /// Groups elements that are near each other at these positions.
    ElementTree(std::span<const Element> elements, const PointArrays& positions);

    /// Fits the boxes to elements that have moved. @param groups  [group_count()] one bit for each element
    /// that may have moved
    void refit(std::span<const Element> elements, const PointArrays& positions,
               std::span<const std::uint8_t> groups, const Workers& workers);
    std::size_t group_count() const { return levels_.empty() ? 0 : levels_[0].group_count(); }

    struct Level {
        /// [a multiple of kWidth] In unused entries, low is infinite and high minus infinite.
        std::array<std::vector<float>, 3> low, high;

        std::size_t group_count() const { return low[0].size() / kWidth; }
        void resize(std::size_t count);
        void set(std::size_t i, const Box& box);
        Box box_of_group(std::size_t first) const;
    };

    /// Which of the eight boxes from `first` on are in use, one bit each. Infinite boxes, or those from a
    /// saved state, may otherwise touch unused ones.
    unsigned present(std::size_t level, std::size_t first) const {
        const std::size_t count = level == 0 ? order_.size() : levels_[level - 1].group_count();
        return first + kWidth <= count ? (1U << kWidth) - 1 : (1U << (count - std::min(first, count))) - 1;
    }
    std::span<const std::uint32_t> order() const { return order_; }
    std::span<const Level> levels() const { return levels_; }

  private:
    template <typename BoxOf>
    void refit_groups(std::span<const std::uint8_t> groups, const Workers& workers, const BoxOf& box_of);
    std::vector<std::uint32_t> order_; ///< the elements, group by group
    std::vector<Level> levels_;        ///< of elements, of their groups and so on, up to a single group
};

} // namespace echinus
