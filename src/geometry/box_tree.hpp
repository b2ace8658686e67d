#pragma once

#include "geometry/box.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// A tree of boxes over items, such as the faces of a mesh or the tetrahedra of a body, split at the median
/// of the boxes' centres along the longest side.
class BoxTree {
  public:
    using Box = AlignedBox<float>;
    static constexpr std::size_t kLeafSize = 4;

    /// Leaves begin to end of the tree's own order. Has no children where there are at most kLeafSize.
    struct Node {
        Box box;
        std::uint32_t begin, end;
        std::uint32_t right; ///< the left child is the next node

        bool is_leaf() const { return end - begin <= kLeafSize; }
        std::uint32_t size() const { return end - begin; }
    };

    struct Leaf {
        Box box;
        std::uint32_t item;
    };

    /// @param boxes  of the items, in their order; at least one, finite
    explicit BoxTree(const std::vector<Box>& boxes);

    const Node& node(std::uint32_t index) const { return nodes_[index]; }
    const Leaf& leaf(std::uint32_t index) const { return leaves_[index]; }

  private:
    void build(std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

inline BoxTree::BoxTree(const std::vector<Box>& boxes) {
    leaves_.reserve(boxes.size());
    for (std::uint32_t item = 0; item < boxes.size(); ++item) leaves_.push_back({boxes[item], item});
    nodes_.reserve(leaves_.size());
    build(0, kept_as<std::uint32_t>(leaves_.size()));
}

inline void BoxTree::build(std::uint32_t begin, std::uint32_t end) {
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

/// Calls visit(item of a, item of b) where their boxes overlap.
template <typename Visit>
void for_each_overlap(const BoxTree& a, std::uint32_t a_index, const BoxTree& b, std::uint32_t b_index,
                      Visit&& visit) {
    const BoxTree::Node &p = a.node(a_index), &q = b.node(b_index);
    if (!p.box.overlaps(q.box)) return;
    if (p.is_leaf() && q.is_leaf()) {
        for (std::uint32_t i = p.begin; i < p.end; ++i)
            for (std::uint32_t j = q.begin; j < q.end; ++j)
                if (a.leaf(i).box.overlaps(b.leaf(j).box)) visit(a.leaf(i).item, b.leaf(j).item);
    } else if (q.is_leaf() || (!p.is_leaf() && p.size() > q.size())) {
        for_each_overlap(a, a_index + 1, b, b_index, visit);
        for_each_overlap(a, p.right, b, b_index, visit);
    } else {
        for_each_overlap(a, a_index, b, b_index + 1, visit);
        for_each_overlap(a, a_index, b, q.right, visit);
    }
}

/// Calls visit(item, item) for the pairs of different items of one tree whose boxes overlap, each pair once.
template <typename Visit>
void for_each_overlap(const BoxTree& tree, std::uint32_t index, Visit&& visit) {
    const BoxTree::Node& node = tree.node(index);
    if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            for (std::uint32_t j = i + 1; j < node.end; ++j)
                if (tree.leaf(i).box.overlaps(tree.leaf(j).box)) visit(tree.leaf(i).item, tree.leaf(j).item);
    } else {
        for_each_overlap(tree, index + 1, visit);
        for_each_overlap(tree, node.right, visit);
        for_each_overlap(tree, index + 1, tree, node.right, visit);
    }
}

} // namespace echinus
