#include "simulation/surfaces/element_tree.hpp"

#include <limits>
#include <numeric>

namespace echinus {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Vec3f middle_of(const Element& element, const PointArrays& positions) {
    const Box box = box_of(element, positions);
    return {box.low[0] + box.high[0], box.low[1] + box.high[1], box.low[2] + box.high[2]};
}

float component(const Vec3f& v, std::size_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

std::size_t longest_axis(std::span<const std::uint32_t> elements, const std::vector<Vec3f>& middles) {
    std::array<float, 3> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float low = kInfinity, high = -kInfinity;
        for (const std::uint32_t e : elements) {
            low = std::min(low, component(middles[e], axis));
            high = std::max(high, component(middles[e], axis));
        }
        extent[axis] = high - low;
    }
    return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
}

/// Splits elements along the longest axis into two halves, such that the first consists of complete groups of
/// the largest possible size.
void sort_into_groups(std::span<std::uint32_t> elements, const std::vector<Vec3f>& middles) {
    if (elements.size() <= ElementTree::kWidth) {
        // nth_element() leaves them in an order that differs between standard libraries.
        std::sort(elements.begin(), elements.end());
        return;
    }
    std::size_t group = ElementTree::kWidth;
    while (group * ElementTree::kWidth < elements.size()) group *= ElementTree::kWidth;
    const std::size_t group_count = (elements.size() + group - 1) / group;
    const std::size_t half = group_count > 1 ? group_count / 2 * group : elements.size();
    if (half == elements.size()) return;
    const std::size_t axis = longest_axis(elements, middles);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const float at_a = component(middles[a], axis), at_b = component(middles[b], axis);
        return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(elements.begin(), elements.begin() + static_cast<std::ptrdiff_t>(half), elements.end(),
                     before);
    sort_into_groups(elements.first(half), middles);
    sort_into_groups(elements.subspan(half), middles);
}

} // namespace

Box box_of(const Element& element, const PointArrays& positions) {
    const Vec3f first = positions[element.vertices[0]];
    Box box{{first.x, first.y, first.z}, {first.x, first.y, first.z}};
    for (std::size_t k = 1; k < element.vertex_count; ++k) {
        const Vec3f p = positions[element.vertices[k]];
        box.low = {std::min(box.low[0], p.x), std::min(box.low[1], p.y), std::min(box.low[2], p.z)};
        box.high = {std::max(box.high[0], p.x), std::max(box.high[1], p.y), std::max(box.high[2], p.z)};
    }
    return box;
}

void ElementTree::Level::resize(std::size_t count) {
    const std::size_t padded = (count + kWidth - 1) / kWidth * kWidth;
    for (std::vector<float>& bound : low) bound.assign(padded, kInfinity);
    for (std::vector<float>& bound : high) bound.assign(padded, -kInfinity);
}

void ElementTree::Level::set(std::size_t i, const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis][i] = box.low[axis];
        high[axis][i] = box.high[axis];
    }
}

Box ElementTree::Level::box_of_group(std::size_t first) const {
    Box box{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float least = kInfinity, most = -kInfinity;
        for (std::size_t k = 0; k < kWidth; ++k) {
            least = std::min(least, low[axis][first + k]);
            most = std::max(most, high[axis][first + k]);
        }
        box.low[axis] = least;
        box.high[axis] = most;
    }
    return box;
}

ElementTree::ElementTree(std::span<const Element> elements, const PointArrays& positions)
    : order_(elements.size()) {
    std::vector<Vec3f> middles;
    middles.reserve(order_.size());
    for (const Element& element : elements) middles.push_back(middle_of(element, positions));
    std::iota(order_.begin(), order_.end(), 0U);
    sort_into_groups(order_, middles);
    std::size_t count = order_.size();
    do {
        levels_.emplace_back().resize(count);
        count = (count + kWidth - 1) / kWidth;
    } while (count > 1);
    refit(elements, positions, std::vector<std::uint8_t>(group_count(), 0xFF), Workers());
}

void ElementTree::refit(std::span<const Element> elements, const PointArrays& positions,
                        std::span<const std::uint8_t> groups, const Workers& workers) {
    refit_groups(groups, workers, [&](std::uint32_t e) { return echinus::box_of(elements[e], positions); });
}

/// Updates the boxes of elements and of their groups in pieces, and then those of larger groups, which are
/// few.
template <typename BoxOf>
void ElementTree::refit_groups(std::span<const std::uint8_t> groups, const Workers& workers,
                               const BoxOf& box_of) {
    constexpr std::size_t kGroupsPerPiece = 128;
    const auto refit_group = [&](std::size_t group) {
        if (groups[group] == 0) return;
        for (std::size_t i = group * kWidth; i < std::min((group + 1) * kWidth, order_.size()); ++i)
            if (((groups[group] >> (i % kWidth)) & 1U) != 0) levels_[0].set(i, box_of(order_[i]));
        if (levels_.size() > 1) levels_[1].set(group, levels_[0].box_of_group(group * kWidth));
    };
    workers.for_ranges(groups.size(), kGroupsPerPiece,
                       [&](std::size_t, std::size_t, std::size_t begin, std::size_t end) {
                           for (std::size_t group = begin; group < end; ++group) refit_group(group);
                       });
    std::size_t count = groups.size();
    for (std::size_t level = 2; level < levels_.size(); ++level) {
        count = (count + kWidth - 1) / kWidth;
        for (std::size_t i = 0; i < count; ++i)
            levels_[level].set(i, levels_[level - 1].box_of_group(i * kWidth));
    }
}

} // namespace echinus
