// Finds the elements of two trees that are near each other, group by group, comparing one element with eight
// at once.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simulation/surfaces/near_elements.cpp"
#include <hwy/foreach_target.h>

// After foreach_target.h, which includes this file once for each instruction set.
#include "simd/dispatch.hpp"
#include "simulation/surfaces/near_elements.hpp"

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace echinus {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The boxes at the beginning and at the end of a displacement.
struct MovingBox {
    Box from, to;

    void grow(float by) {
        from.grow(by);
        to.grow(by);
    }
};

/// Which of the eight boxes from `first` on this box may touch, one bit each.
HWY_INLINE unsigned touching(const MovingTree& tree, std::size_t level, std::size_t first,
                             const MovingBox& box) {
    constexpr hn::CappedTag<float, ElementTree::kWidth> d;
    const ElementTree::Level &from = tree.from.levels()[level], &to = tree.to.levels()[level];
    unsigned mask = 0;
    for (std::size_t lane = 0; lane < ElementTree::kWidth; lane += hn::Lanes(d)) {
        const std::size_t i = first + lane;
        const auto apart_along = [&](std::size_t axis) HWY_ATTR {
            const auto above =
                hn::And(hn::Gt(hn::LoadU(d, &from.low[axis][i]), hn::Set(d, box.from.high[axis])),
                        hn::Gt(hn::LoadU(d, &to.low[axis][i]), hn::Set(d, box.to.high[axis])));
            const auto below =
                hn::And(hn::Lt(hn::LoadU(d, &from.high[axis][i]), hn::Set(d, box.from.low[axis])),
                        hn::Lt(hn::LoadU(d, &to.high[axis][i]), hn::Set(d, box.to.low[axis])));
            return hn::Or(above, below);
        };
        const auto apart = hn::Or(apart_along(0), hn::Or(apart_along(1), apart_along(2)));
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(d, hn::Not(apart), bits.data());
        const unsigned lanes_mask = (1U << hn::Lanes(d)) - 1;
        mask |= (bits[0] & lanes_mask) << lane;
    }
    return mask & tree.from.present(level, first);
}

HWY_INLINE Box box_of(const ElementTree::Level& boxes, std::size_t i) {
    return {{boxes.low[0][i], boxes.low[1][i], boxes.low[2][i]},
            {boxes.high[0][i], boxes.high[1][i], boxes.high[2][i]}};
}

HWY_INLINE void enclose(Box& box, const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], other.low[axis]);
        box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
}

/// Compares the wanted elements of one group of `a` with all elements of `b`.
struct GroupSearch {
    const MovingTree& a;
    const MovingTree& b;
    bool is_same;
    float reach;
    std::vector<std::array<std::uint32_t, 2>>& near;
    std::size_t group = 0; ///< of `a`
    std::array<MovingBox, ElementTree::kWidth> boxes{};

    void search_piece(std::size_t piece) {
        const std::size_t first = piece * MovingTree::kGroupsPerPiece;
        const std::size_t end = std::min(first + MovingTree::kGroupsPerPiece, a.wanted.size());
        for (group = first; group < end; ++group)
            if (a.wanted[group] != 0) search_group();
    }

    void search_group() {
        const std::size_t first = group * ElementTree::kWidth;
        MovingBox around;
        for (unsigned rest = a.wanted[group], n = 0; rest != 0; rest &= rest - 1, ++n) {
            const auto k = static_cast<std::size_t>(std::countr_zero(rest));
            boxes[k] = {box_of(a.from.levels()[0], first + k), box_of(a.to.levels()[0], first + k)};
            boxes[k].grow(reach);
            if (n == 0) around = boxes[k];
            enclose(around.from, boxes[k].from);
            enclose(around.to, boxes[k].to);
        }
        if (const std::size_t top = b.from.levels().size() - 1; top > 0) return search(top, 0, around);
        for (unsigned rest = a.wanted[group]; rest != 0; rest &= rest - 1)
            compare(static_cast<std::size_t>(std::countr_zero(rest)), 0);
    }

    void search(std::size_t level, std::size_t first, const MovingBox& around) {
        if (level == 1) return compare_groups(first);
        for (unsigned mask = touching(b, level, first, around); mask != 0; mask &= mask - 1)
            search(level - 1,
                   (first + static_cast<std::size_t>(std::countr_zero(mask))) * ElementTree::kWidth, around);
    }

    /// Compares with the elements of eight groups of `b`.
    void compare_groups(std::size_t first) {
        for (unsigned rest = a.wanted[group]; rest != 0; rest &= rest - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(rest));
            for (unsigned mask = touching(b, 1, first, boxes[k]); mask != 0; mask &= mask - 1)
                compare(k, first + static_cast<std::size_t>(std::countr_zero(mask)));
        }
    }

    /// If both elements are wanted ones of the same tree, only the first finds the second.
    unsigned left_to(std::size_t k, std::size_t other) const {
        if (!is_same || other > group) return ~0U;
        const unsigned others = ~static_cast<unsigned>(b.wanted[other]);
        if (other < group) return others;
        return (others & ~(1U << k)) | (~1U << k);
    }

    void compare(std::size_t k, std::size_t other) {
        const std::size_t first = other * ElementTree::kWidth;
        unsigned mask = left_to(k, other) & 0xFF;
        if (mask == 0) return;
        for (mask &= touching(b, 0, first, boxes[k]); mask != 0; mask &= mask - 1)
            near.push_back({a.from.order()[group * ElementTree::kWidth + k],
                            b.from.order()[first + static_cast<std::size_t>(std::countr_zero(mask))]});
    }
};

void find_near_lanes(const MovingTree& a, const MovingTree& b, float reach, std::size_t piece,
                     std::vector<std::array<std::uint32_t, 2>>& near) {
    GroupSearch{.a = a, .b = b, .is_same = &a == &b, .reach = reach, .near = near}.search_piece(piece);
}

} // namespace HWY_NAMESPACE
} // namespace echinus
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {
HWY_EXPORT(find_near_lanes);
} // namespace

void find_near(const MovingTree& a, const MovingTree& b, float reach, std::size_t piece,
               std::vector<std::array<std::uint32_t, 2>>& near) {
    if (a.from.order().empty() || b.from.order().empty()) return;
    ECHINUS_DISPATCH(find_near_lanes)(a, b, reach, piece, near);
}

} // namespace echinus
#endif // HWY_ONCE
