// Which elements of two trees are near each other: group by group, one element against eight at once.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/surfaces/near_elements.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simulation/surfaces/near_elements.hpp"

#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <span>

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Which of the eight boxes from `first` on touch this one, one bit each.
HWY_INLINE unsigned touching(const ElementTree::Level& boxes, std::size_t first, const Box& box) {
    constexpr hn::CappedTag<float, ElementTree::kWidth> d;
    unsigned mask = 0;
    for (std::size_t lane = 0; lane < ElementTree::kWidth; lane += hn::Lanes(d)) {
        auto apart = hn::Gt(hn::LoadU(d, &boxes.low[0][first + lane]), hn::Set(d, box.high[0]));
        apart = hn::Or(apart, hn::Lt(hn::LoadU(d, &boxes.high[0][first + lane]), hn::Set(d, box.low[0])));
        for (std::size_t axis = 1; axis < 3; ++axis) {
            apart = hn::Or(apart,
                           hn::Gt(hn::LoadU(d, &boxes.low[axis][first + lane]), hn::Set(d, box.high[axis])));
            apart = hn::Or(apart,
                           hn::Lt(hn::LoadU(d, &boxes.high[axis][first + lane]), hn::Set(d, box.low[axis])));
        }
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(d, hn::Not(apart), bits.data());
        const unsigned lanes_mask = (1U << hn::Lanes(d)) - 1;
        mask |= (bits[0] & lanes_mask) << lane;
    }
    return mask;
}

HWY_INLINE Box box_of(const ElementTree::Level& boxes, std::size_t i) {
    return {{boxes.low[0][i], boxes.low[1][i], boxes.low[2][i]},
            {boxes.high[0][i], boxes.high[1][i], boxes.high[2][i]}};
}

/// One search: the elements of one group of `a` against all of `b`.
struct GroupSearch {
    const ElementTree& a;
    const ElementTree& b;
    bool is_same;
    std::vector<std::array<std::uint32_t, 2>>& near;
    std::size_t group = 0;                        ///< of `a`
    std::array<Box, ElementTree::kWidth> boxes{}; ///< of its elements, grown by the reach
    std::size_t box_count = 0;

    void search(std::size_t level, std::size_t first, const Box& around) {
        // Groups before this one have found it.
        unsigned mask = touching(b.levels()[level], first, around);
        for (; mask != 0; mask &= mask - 1) {
            const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(mask));
            if (level > 1)
                search(level - 1, i * ElementTree::kWidth, around);
            else if (!is_same || i >= group)
                compare(i);
        }
    }

    void compare(std::size_t other) {
        const std::size_t first = other * ElementTree::kWidth;
        for (std::size_t k = 0; k < box_count; ++k) {
            unsigned mask = touching(b.levels()[0], first, boxes[k]);
            if (is_same && other == group) mask &= ~0U << (k + 1);
            for (; mask != 0; mask &= mask - 1)
                near.push_back({a.order()[group * ElementTree::kWidth + k],
                                b.order()[first + static_cast<std::size_t>(std::countr_zero(mask))]});
        }
    }
};

void find_near_lanes(const ElementTree& a, const ElementTree& b, float reach,
                     std::vector<std::array<std::uint32_t, 2>>& near) {
    GroupSearch search{.a = a, .b = b, .is_same = &a == &b, .near = near};
    const std::size_t group_count = a.levels()[0].group_count();
    for (std::size_t group = 0; group < group_count; ++group) {
        search.group = group;
        const std::size_t first = group * ElementTree::kWidth;
        search.box_count = std::min(ElementTree::kWidth, a.order().size() - first);
        Box around = box_of(a.levels()[0], first);
        for (std::size_t k = 0; k < search.box_count; ++k) {
            search.boxes[k] = box_of(a.levels()[0], first + k);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                around.low[axis] = std::min(around.low[axis], search.boxes[k].low[axis]);
                around.high[axis] = std::max(around.high[axis], search.boxes[k].high[axis]);
            }
            search.boxes[k].grow(reach);
        }
        around.grow(reach);
        const std::size_t top = b.levels().size() - 1;
        if (top == 0)
            search.compare(0);
        else
            search.search(top, 0, around);
    }
}

void find_near_box(const ElementTree& tree, std::size_t level, std::size_t first, const Box& box,
                   std::uint32_t number, std::vector<std::array<std::uint32_t, 2>>& near) {
    for (unsigned mask = touching(tree.levels()[level], first, box); mask != 0; mask &= mask - 1) {
        const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(mask));
        if (level == 0)
            near.push_back({number, tree.order()[i]});
        else
            find_near_box(tree, level - 1, i * ElementTree::kWidth, box, number, near);
    }
}

void find_near_boxes(std::span<const Box> boxes, const ElementTree& tree, float reach,
                     std::vector<std::array<std::uint32_t, 2>>& near) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        Box box = boxes[i];
        box.grow(reach);
        find_near_box(tree, tree.levels().size() - 1, 0, box, i, near);
    }
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {
HWY_EXPORT(find_near_lanes);
HWY_EXPORT(find_near_boxes);
} // namespace

void find_near(const ElementTree& a, const ElementTree& b, float reach,
               std::vector<std::array<std::uint32_t, 2>>& near) {
    if (a.order().empty() || b.order().empty()) return;
    ECHINUS_DISPATCH(find_near_lanes)(a, b, reach, near);
}

void find_near(std::span<const Box> boxes, const ElementTree& tree, float reach,
               std::vector<std::array<std::uint32_t, 2>>& near) {
    if (tree.order().empty()) return;
    ECHINUS_DISPATCH(find_near_boxes)(boxes, tree, reach, near);
}

} // namespace echinus
#endif // HWY_ONCE
