#include "exact_map/face_tree.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace echinus {

namespace {

constexpr std::size_t kWidth = TreeNode::kWidth;

using Coordinates = std::array<std::int32_t, 3>;

struct Box {
    Coordinates low, high;

    void add(const Box& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
    }
};

/// What the tree sorts: it moves these about, so that comparisons need no look-up.
struct Item {
    Coordinates thrice_centroid;
    std::uint32_t face;
};

std::int16_t divided_down(std::int32_t value) {
    constexpr std::int32_t kUnit = ExactMapView::kBoxUnit;
    return static_cast<std::int16_t>((value >= 0 ? value : value - (kUnit - 1)) / kUnit);
}

class TreeBuilder {
  public:
    explicit TreeBuilder(const LatticeMesh& lattice) : lattice_(lattice), items_(lattice.faces.size()) {
        for (std::uint32_t face = 0; face < items_.size(); ++face) items_[face] = item_of(face);
        nodes_.reserve(items_.size() / (kWidth * (kWidth - 1)) + 8);
    }

    FaceTree build() {
        add_node(0, (items_.size() + kWidth - 1) / kWidth);
        std::vector<std::uint32_t> order;
        order.reserve(items_.size());
        for (const Item& item : items_) order.push_back(item.face);
        return {std::move(nodes_), std::move(order)};
    }

  private:
    Item item_of(std::uint32_t face) const {
        LatticePoint sum;
        for (std::uint32_t vertex : lattice_.faces[face]) sum += lattice_.vertices[vertex];
        return {{static_cast<std::int32_t>(sum.x), static_cast<std::int32_t>(sum.y),
                 static_cast<std::int32_t>(sum.z)},
                face};
    }

    /// Adds the node over some leaves and all below it. Returns their box.
    Box add_node(std::size_t first_leaf, std::size_t leaf_count) {
        std::size_t leaves_per_child = 1;
        while (leaves_per_child * kWidth < leaf_count) leaves_per_child *= kWidth;
        const std::size_t child_count = (leaf_count + leaves_per_child - 1) / leaves_per_child;
        part(first_leaf, first_leaf + leaf_count, child_count, leaves_per_child);

        const auto node = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(empty_node());
        Box box{};
        for (std::size_t child = 0; child < child_count; ++child) {
            const std::size_t first = first_leaf + child * leaves_per_child;
            const std::size_t count = std::min(leaves_per_child, first_leaf + leaf_count - first);
            const bool is_leaf = leaves_per_child == 1;
            nodes_[node].children[child] = is_leaf ? TreeNode::kLeaf + static_cast<std::uint32_t>(first)
                                                   : static_cast<std::uint32_t>(nodes_.size());
            const Box child_box = is_leaf ? finish_leaf(first) : add_node(first, count);
            set_box(nodes_[node], child, child_box);
            if (child == 0)
                box = child_box;
            else
                box.add(child_box);
        }
        return box;
    }

    /// Sorts leaves so that each child's lie together: halves the number of children, again and again.
    void part(std::size_t first_leaf, std::size_t last_leaf, std::size_t child_count,
              std::size_t leaves_per_child) {
        if (child_count <= 1) return;
        const std::size_t left_count = child_count / 2;
        const std::size_t middle_leaf = first_leaf + left_count * leaves_per_child;
        sort_around(first_leaf * kWidth, middle_leaf * kWidth, std::min(last_leaf * kWidth, items_.size()));
        part(first_leaf, middle_leaf, left_count, leaves_per_child);
        part(middle_leaf, last_leaf, child_count - left_count, leaves_per_child);
    }

    /// Puts the faces with the smaller centroids along the longest side before `middle`; ties by number, so
    /// that which faces these are is a function of the mesh alone.
    void sort_around(std::size_t first, std::size_t middle, std::size_t last) {
        Box box{items_[first].thrice_centroid, items_[first].thrice_centroid};
        for (std::size_t i = first; i < last; ++i)
            box.add({items_[i].thrice_centroid, items_[i].thrice_centroid});
        std::size_t axis = 0;
        for (std::size_t other = 1; other < 3; ++other)
            if (box.high[other] - box.low[other] > box.high[axis] - box.low[axis]) axis = other;
        const auto begin = items_.begin();
        std::nth_element(begin + static_cast<std::ptrdiff_t>(first),
                         begin + static_cast<std::ptrdiff_t>(middle),
                         begin + static_cast<std::ptrdiff_t>(last), [axis](const Item& a, const Item& b) {
                             if (a.thrice_centroid[axis] != b.thrice_centroid[axis])
                                 return a.thrice_centroid[axis] < b.thrice_centroid[axis];
                             return a.face < b.face;
                         });
    }

    /// Orders a leaf's faces by number: how nth_element leaves them differs between standard libraries.
    Box finish_leaf(std::size_t leaf) {
        const std::size_t first = leaf * kWidth;
        const std::size_t last = std::min(first + kWidth, items_.size());
        std::sort(items_.begin() + static_cast<std::ptrdiff_t>(first),
                  items_.begin() + static_cast<std::ptrdiff_t>(last),
                  [](const Item& a, const Item& b) { return a.face < b.face; });
        Box box = box_of(items_[first].face);
        for (std::size_t i = first + 1; i < last; ++i) box.add(box_of(items_[i].face));
        return box;
    }

    Box box_of(std::uint32_t face) const {
        const auto corner = [&](std::size_t k) {
            const Vec3<std::int32_t> v(lattice_.vertices[lattice_.faces[face][k]]);
            return Box{{v.x, v.y, v.z}, {v.x, v.y, v.z}};
        };
        Box box = corner(0);
        box.add(corner(1));
        box.add(corner(2));
        return box;
    }

    static TreeNode empty_node() {
        TreeNode node{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::fill(node.low[axis], node.low[axis] + kWidth, std::numeric_limits<std::int16_t>::max());
            std::fill(node.high[axis], node.high[axis] + kWidth, std::numeric_limits<std::int16_t>::min());
        }
        return node;
    }

    static void set_box(TreeNode& node, std::size_t child, const Box& box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            node.low[axis][child] = divided_down(box.low[axis]);
            node.high[axis][child] = static_cast<std::int16_t>(-divided_down(-box.high[axis]));
        }
    }

    const LatticeMesh& lattice_;
    std::vector<Item> items_;
    std::vector<TreeNode> nodes_;
};

} // namespace

FaceTree build_face_tree(const LatticeMesh& lattice) {
    return TreeBuilder(lattice).build();
}

} // namespace echinus
