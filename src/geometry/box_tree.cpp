#include "geometry/box_tree.hpp"

#include "geometry/whole_numbers.hpp"

#include <algorithm>

namespace echinus {

BoxTree::BoxTree(const std::vector<Box>& boxes) {
    leaves_.reserve(boxes.size());
    for (std::uint32_t item = 0; item < boxes.size(); ++item) leaves_.push_back({boxes[item], item});
    nodes_.reserve(leaves_.size());
    build(0, kept_as<std::uint32_t>(leaves_.size()));
}

void BoxTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = kept_as<std::uint32_t>(nodes_.size());
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.add(leaves_[i].box);
    nodes_.push_back({box, begin, end, 0});
    if (nodes_[index].is_leaf()) return;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto axis = box.longest_axis();
    const auto centre = [axis](const Leaf& leaf) { return double{leaf.box.low.*axis} + leaf.box.high.*axis; };
    std::nth_element(leaves_.begin() + begin, leaves_.begin() + middle, leaves_.begin() + end,
                     [&](const Leaf& p, const Leaf& q) { return centre(p) < centre(q); });
    build(begin, middle);
    nodes_[index].right = kept_as<std::uint32_t>(nodes_.size());
    build(middle, end);
}

} // namespace echinus
