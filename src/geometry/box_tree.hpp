#pragma once

#include "geometry/box.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// A tree of boxes over items, such as the faces of a mesh or the tetrahedra of a body. A node is split when
/// a search first reaches it, so that two surfaces that meet in a few places require only the nodes there.
class BoxTree {
  public:
    using Box = AlignedBox<float>;
    static constexpr std::size_t kLeafSize = 4;

    /// A node holds the leaves [begin, end) in the tree's own order. It has no children if these are at most
    /// kLeafSize.
    struct Node {
        Box box;
        std::uint32_t begin, end;
        std::uint32_t left = 0; ///< the right child is the next node; 0: not split yet

        bool is_leaf() const { return end - begin <= kLeafSize; }
        std::uint32_t size() const { return end - begin; }
        std::uint32_t right() const { return left + 1; }
    };

    struct Leaf {
        Box box;
        std::uint32_t item;
    };

    /// @param boxes  the boxes of the items, in their order; at least one, all finite
    explicit BoxTree(const std::vector<Box>& boxes);

    /// References stay valid when other nodes are split.
    const Node& node(std::uint32_t index) const { return nodes_[index]; }
    const Leaf& leaf(std::uint32_t index) const { return leaves_[index]; }

    /// Creates the children of a node, unless it has them. @pre the node is not a leaf
    void split(std::uint32_t index) {
        if (nodes_[index].left == 0) make_children(index);
    }
    /// Splits all nodes, for searches that must not change the tree.
    void split_all();

  private:
    void make_children(std::uint32_t index);
    void add_node(std::uint32_t begin, std::uint32_t end);
    std::uint32_t middle_of(const Node& node);

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

inline BoxTree::BoxTree(const std::vector<Box>& boxes) {
    leaves_.reserve(boxes.size());
    for (std::uint32_t item = 0; item < boxes.size(); ++item) leaves_.push_back({boxes[item], item});
    nodes_.reserve(leaves_.size()); // the most that there may be: a node's child has at least two leaves
    add_node(0, kept_as<std::uint32_t>(leaves_.size()));
}

inline void BoxTree::split_all() {
    for (std::uint32_t index = 0; index < nodes_.size(); ++index)
        if (!nodes_[index].is_leaf()) split(index);
}

inline void BoxTree::make_children(std::uint32_t index) {
    Node& node = nodes_[index];
    const std::uint32_t middle = middle_of(node);
    node.left = kept_as<std::uint32_t>(nodes_.size());
    add_node(node.begin, middle);
    add_node(middle, node.end);
}

inline void BoxTree::add_node(std::uint32_t begin, std::uint32_t end) {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.add(leaves_[i].box);
    nodes_.push_back({box, begin, end});
}

/// Divides the leaves of a node by their centres along the longest side: at the middle of that side, in one
/// pass, or, if a part would then have less than a quarter of the leaves, at the median.
inline std::uint32_t BoxTree::middle_of(const Node& node) {
    const auto axis = node.box.longest_axis();
    const auto twice_centre = [axis](const Box& box) { return double{box.low.*axis} + box.high.*axis; };
    const auto begin = leaves_.begin() + node.begin, end = leaves_.begin() + node.end;
    const double middle = twice_centre(node.box);
    auto divided =
        std::partition(begin, end, [&](const Leaf& leaf) { return twice_centre(leaf.box) < middle; });
    if (4 * std::min(divided - begin, end - divided) < end - begin) {
        divided = begin + (end - begin) / 2;
        std::nth_element(begin, divided, end, [&](const Leaf& p, const Leaf& q) {
            return twice_centre(p.box) < twice_centre(q.box);
        });
    }
    return kept_as<std::uint32_t>(divided - leaves_.begin());
}

/// Calls visit(item of a, item of b) for the pairs of items whose boxes overlap. Splits the nodes that it
/// enters.
template <typename Visit>
void for_each_overlap(BoxTree& a, std::uint32_t a_index, BoxTree& b, std::uint32_t b_index, Visit&& visit) {
    const BoxTree::Node &p = a.node(a_index), &q = b.node(b_index);
    if (!p.box.overlaps(q.box)) return;
    if (p.is_leaf() && q.is_leaf()) {
        for (std::uint32_t i = p.begin; i < p.end; ++i)
            for (std::uint32_t j = q.begin; j < q.end; ++j)
                if (a.leaf(i).box.overlaps(b.leaf(j).box)) visit(a.leaf(i).item, b.leaf(j).item);
    } else if (q.is_leaf() || (!p.is_leaf() && p.size() > q.size())) {
        a.split(a_index);
        for_each_overlap(a, p.left, b, b_index, visit);
        for_each_overlap(a, p.right(), b, b_index, visit);
    } else {
        b.split(b_index);
        for_each_overlap(a, a_index, b, q.left, visit);
        for_each_overlap(a, a_index, b, q.right(), visit);
    }
}

/// Calls visit(item, item) for the pairs of different items of one tree whose boxes overlap, each pair once.
template <typename Visit>
void for_each_overlap(BoxTree& tree, std::uint32_t index, Visit&& visit) {
    const BoxTree::Node& node = tree.node(index);
    if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            for (std::uint32_t j = i + 1; j < node.end; ++j)
                if (tree.leaf(i).box.overlaps(tree.leaf(j).box)) visit(tree.leaf(i).item, tree.leaf(j).item);
    } else {
        tree.split(index);
        for_each_overlap(tree, node.left, visit);
        for_each_overlap(tree, node.right(), visit);
        for_each_overlap(tree, node.left, tree, node.right(), visit);
    }
}

} // namespace echinus
