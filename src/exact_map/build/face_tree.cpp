#include "exact_map/build/face_tree.hpp"

#include "geometry/parallel.hpp"
#include "geometry/whole_numbers.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace echinus {

namespace {

using Places = std::array<std::uint32_t, 3>;

struct Box {
    Places low, high;
};

Box box_of(std::span<const TreeItem> items) {
    Box box{items[0].place, items[0].place};
    for (const TreeItem& item : items)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], item.place[axis]);
            box.high[axis] = std::max(box.high[axis], item.place[axis]);
        }
    return box;
}

/// Orders items by their place along one axis, ties by number.
class KeyAlong {
  public:
    explicit KeyAlong(std::size_t axis) : axis_(axis) {}
    std::uint64_t operator()(const TreeItem& item) const { return packed<32>(item.place[axis_], item.face); }

  private:
    std::size_t axis_;
};

/// Puts items whose keys are below the limit first, and returns how many there are. Every item is swapped,
/// and only the increment of a position depends on the comparison: nothing that a processor could mispredict.
template <typename Key>
std::size_t partition_below(std::span<TreeItem> items, std::uint64_t limit, const Key& key) {
    std::size_t below = 0;
    for (TreeItem& item : items) {
        const TreeItem moved = item;
        item = items[below];
        items[below] = moved;
        below += key(moved) < limit ? 1 : 0;
    }
    return below;
}

/// Sorts by counting, for each key, how many come before it. This compares all pairs without a branch.
template <std::size_t kMost, typename Key>
void sort_few(std::span<TreeItem> items, const Key& key) {
    std::array<std::uint64_t, kMost> keys;
    std::array<std::uint32_t, kMost> rank;
    std::array<TreeItem, kMost> copy;
    for (std::size_t i = 0; i < items.size(); ++i) {
        copy[i] = items[i];
        keys[i] = key(items[i]);
        std::uint32_t smaller = 0;
        for (std::size_t k = 0; k < i; ++k) {
            const std::uint32_t is_smaller = keys[k] < keys[i] ? 1 : 0;
            smaller += is_smaller;
            rank[k] += 1 - is_smaller;
        }
        rank[i] = smaller;
    }
    const std::size_t count = items.size();
    for (std::size_t i = 0; i < count; ++i) items[rank[i]] = copy[i];
}

/// Estimates, from a sample, a key below which there are about `left_count` items. The estimate errs towards
/// the middle, so that the next search has fewer items to examine.
template <typename Key>
std::uint64_t estimated_limit(std::span<const TreeItem> items, std::size_t left_count, const Key& key) {
    constexpr std::size_t kLargestSample = 64;
    std::array<std::uint64_t, kLargestSample> sample;
    const std::size_t size = items.size() >= 2048 ? kLargestSample : items.size() >= 256 ? 24 : 8;
    for (std::size_t i = 0; i < size; ++i) sample[i] = key(items[i * items.size() / size]);
    std::sort(sample.begin(), sample.begin() + size);
    const std::size_t wanted = left_count * size / items.size();
    // Shifted from the wanted element by about the error of a sample, away from the nearer end.
    const std::size_t margin = size >= 24 ? size / 12 : 1;
    const std::size_t chosen = 2 * left_count <= items.size() ? std::min(wanted + margin, size - 1)
                                                              : wanted - std::min(margin, wanted);
    return sample[chosen];
}

/// Puts the `left_count` smallest items first (Hoare's selection, with limits from samples as in Floyd and
/// Rivest 1975).
template <typename Key>
void select(std::span<TreeItem> items, std::size_t left_count, const Key& key) {
    constexpr std::size_t kFew = 24;
    while (left_count > 0 && left_count < items.size()) {
        if (items.size() <= kFew) return sort_few<kFew>(items, key);
        std::uint64_t limit = estimated_limit(items, left_count, key);
        std::size_t below = partition_below(items, limit, key);
        if (below == 0) below = partition_below(items, limit + 1, key); // the limit was the smallest key
        if (below <= left_count) {
            items = items.subspan(below);
            left_count -= below;
        } else {
            items = items.first(below);
        }
    }
}

} // namespace

void split_at_longest_side(std::span<TreeItem> items, std::size_t left_count) {
    const std::span<TreeItem> left = items.first(left_count), right = items.subspan(left_count);
    const Box left_box = box_of(left), right_box = box_of(right);
    const auto low = [&](std::size_t axis) { return std::min(left_box.low[axis], right_box.low[axis]); };
    const auto side = [&](std::size_t axis) {
        return std::max(left_box.high[axis], right_box.high[axis]) - low(axis);
    };
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other)
        if (side(other) > side(axis)) axis = other;

    const std::uint32_t overlap_low = right_box.low[axis], overlap_high = left_box.high[axis];
    if (overlap_high < overlap_low) return; // the halves are already separated
    const KeyAlong key(axis);
    if (overlap_high - overlap_low > side(axis) / 4) return select(items, left_count, key);
    // Items to the left of all items of the right half stay there, and likewise on the other side.
    const std::size_t left_sure = partition_below(left, packed<32>(overlap_low, 0), key);
    const std::size_t right_unsure = partition_below(right, packed<32>(overlap_high + 1, 0), key);
    select(items.subspan(left_sure, left_count - left_sure + right_unsure), left_count - left_sure, key);
}

void sort_by_face(std::span<TreeItem> few) {
    constexpr std::size_t kFew = 8;
    if (few.size() <= kFew)
        return sort_few<kFew>(few, [](const TreeItem& item) { return std::uint64_t{item.face}; });
    std::sort(few.begin(), few.end(), [](const TreeItem& a, const TreeItem& b) { return a.face < b.face; });
}

namespace {

constexpr std::size_t kWidth = TreeNode::kWidth;

/// A box in the units of a node, rounded outwards. Rounding preserves the order, so boxes of boxes are as
/// tight as boxes of faces.
struct NodeBox {
    std::int16_t low[3], high[3];

    void add(const NodeBox& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], other.low[axis]);
            high[axis] = std::max(high[axis], other.high[axis]);
        }
    }
};

constexpr NodeBox empty_box() {
    constexpr std::int16_t kLow = std::numeric_limits<std::int16_t>::min();
    constexpr std::int16_t kHigh = std::numeric_limits<std::int16_t>::max();
    return {{kHigh, kHigh, kHigh}, {kLow, kLow, kLow}};
}

std::int16_t divided_down(std::int64_t value) {
    constexpr std::int64_t kUnit = ExactMapView::kBoxUnit;
    return kept_as<std::int16_t>((value >= 0 ? value : value - (kUnit - 1)) / kUnit);
}

std::int16_t divided_up(std::int64_t value) {
    return kept_as<std::int16_t>(-divided_down(-value));
}

NodeBox box_of_child(const TreeNode& node, std::size_t child) {
    return {{node.low[0][child], node.low[1][child], node.low[2][child]},
            {node.high[0][child], node.high[1][child], node.high[2][child]}};
}

void set_box_of_child(TreeNode& node, std::size_t child, const NodeBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low[axis][child] = box.low[axis];
        node.high[axis][child] = box.high[axis];
    }
}

NodeBox box_of_node(const TreeNode& node) {
    NodeBox box = box_of_child(node, 0);
    for (std::size_t child = 1; child < kWidth; ++child) box.add(box_of_child(node, child));
    return box;
}

TreeNode empty_node() {
    TreeNode node{};
    for (std::size_t child = 0; child < kWidth; ++child) set_box_of_child(node, child, empty_box());
    return node;
}

/// Leaves to be distributed among neighbouring children of a node, starting with child number `child`.
struct Branch {
    std::size_t first_leaf, last_leaf; ///< half open
    std::size_t leaves_per_child;      ///< a power of kWidth; the last child may have fewer
    std::size_t node, child;

    std::size_t leaf_count() const { return last_leaf - first_leaf; }
    std::size_t child_count() const { return (leaf_count() + leaves_per_child - 1) / leaves_per_child; }
};

std::size_t leaves_per_child_of(std::size_t leaf_count) {
    std::size_t leaves_per_child = 1;
    while (leaves_per_child * kWidth < leaf_count) leaves_per_child *= kWidth;
    return leaves_per_child;
}

/// The number of nodes of a tree with this many leaves, a power of kWidth; none for a single leaf.
std::size_t nodes_of_full_tree(std::size_t leaf_count) {
    return (leaf_count - 1) / (kWidth - 1);
}

std::size_t nodes_of_tree(std::size_t leaf_count) {
    const std::size_t leaves_per_child = leaves_per_child_of(leaf_count);
    const std::size_t full = leaf_count / leaves_per_child, rest = leaf_count % leaves_per_child;
    return 1 + full * nodes_of_full_tree(leaves_per_child) + (rest > 0 ? nodes_of_tree(rest) : 0);
}

class TreeBuilder {
  public:
    TreeBuilder(const LatticeMesh& lattice, unsigned thread_count, FaceTree& tree)
        : lattice_(lattice), thread_count_(thread_count), tree_(tree), items_(lattice.faces.size()) {
        if (tree.order.size() != items_.size()) {
            tree.order.resize(items_.size());
            for (std::uint32_t face = 0; face < items_.size(); ++face) tree.order[face] = face;
        }
        tree.nodes.resize(nodes_of_tree(leaf_count()));
    }

    void build() {
        parallel_for(items_.size(), thread_count_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) items_[i] = item_of(tree_.order[i]);
        });
        grow();
        parallel_for(items_.size(), thread_count_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) tree_.order[i] = items_[i].face;
        });
    }

  private:
    std::size_t leaf_count() const { return (items_.size() + kWidth - 1) / kWidth; }

    TreeItem item_of(std::uint32_t face) const {
        constexpr std::int64_t kPositive = 3 * (kLatticeExtent + 1);
        LatticePoint sum{kPositive, kPositive, kPositive}; // three times the centroid
        for (std::uint32_t vertex : lattice_.faces[face]) sum += lattice_.vertices[vertex];
        return {{kept_as<std::uint32_t>(sum.x), kept_as<std::uint32_t>(sum.y), kept_as<std::uint32_t>(sum.z)},
                face};
    }

    /// Splits branches level by level until there are enough for all threads, then grows each on one thread.
    void grow() {
        const std::size_t enough = thread_count_ == 1 ? 1 : 8 * worker_count(thread_count_);
        std::vector<Branch> branches{branch_of_node(0, 0, leaf_count())};
        std::vector<Branch> nodes; // those made from a branch, and where their boxes go
        for (bool done = false; branches.size() < enough && !done;) {
            done = true;
            std::vector<Branch> next;
            split_all(branches);
            for (const Branch& branch : branches) {
                if (branch.child_count() > 1) {
                    const auto [left, right] = halves(branch);
                    next.insert(next.end(), {left, right});
                    done = false;
                } else if (branch.leaves_per_child > 1) {
                    nodes.push_back(branch);
                    next.push_back(
                        branch_of_node(add_child_node(branch), branch.first_leaf, branch.last_leaf));
                    done = false;
                } else {
                    next.push_back(branch);
                }
            }
            branches = std::move(next);
        }
        parallel_for(branches.size(), thread_count_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) grow(branches[i]);
        });
        for (std::size_t i = nodes.size(); i-- > 0;) finish_child_node(nodes[i]);
    }

    void split_all(const std::vector<Branch>& branches) {
        parallel_for(branches.size(), thread_count_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (branches[i].child_count() > 1) split(branches[i]);
        });
    }

    void grow(const Branch& branch) {
        if (branch.child_count() > 1) {
            split(branch);
            const auto [left, right] = halves(branch);
            grow(left);
            grow(right);
        } else if (branch.leaves_per_child > 1) {
            grow(branch_of_node(add_child_node(branch), branch.first_leaf, branch.last_leaf));
            finish_child_node(branch);
        } else {
            add_leaf(branch);
        }
    }

    /// The branch that contains all children of a new node.
    Branch branch_of_node(std::size_t node, std::size_t first_leaf, std::size_t last_leaf) {
        tree_.nodes[node] = empty_node();
        return {first_leaf, last_leaf, leaves_per_child_of(last_leaf - first_leaf), node, 0};
    }

    static std::pair<Branch, Branch> halves(const Branch& branch) {
        const std::size_t left_count = branch.child_count() / 2;
        const std::size_t middle_leaf = branch.first_leaf + left_count * branch.leaves_per_child;
        Branch left = branch, right = branch;
        left.last_leaf = right.first_leaf = middle_leaf;
        right.child += left_count;
        return {left, right};
    }

    void split(const Branch& branch) {
        const std::size_t middle_leaf = halves(branch).second.first_leaf;
        split_at_longest_side(items_of(branch), (middle_leaf - branch.first_leaf) * kWidth);
    }

    std::span<TreeItem> items_of(const Branch& branch) {
        const std::size_t first = branch.first_leaf * kWidth;
        const std::size_t last = std::min(branch.last_leaf * kWidth, items_.size());
        return std::span(items_).subspan(first, last - first);
    }

    /// Nodes are numbered depth first, and all children except the last are full. @returns the node's number
    std::size_t add_child_node(const Branch& branch) {
        const std::size_t node = branch.node + 1 + branch.child * nodes_of_full_tree(branch.leaves_per_child);
        tree_.nodes[branch.node].children[branch.child] = kept_as<std::uint32_t>(node);
        return node;
    }

    void finish_child_node(const Branch& branch) {
        TreeNode& node = tree_.nodes[branch.node];
        set_box_of_child(node, branch.child, box_of_node(tree_.nodes[node.children[branch.child]]));
    }

    /// Orders a leaf's faces by number, since the splits leave them in arbitrary order.
    void add_leaf(const Branch& branch) {
        const std::span<TreeItem> items = items_of(branch);
        sort_by_face(items);
        TreeNode& node = tree_.nodes[branch.node];
        node.children[branch.child] = TreeNode::kLeaf + kept_as<std::uint32_t>(branch.first_leaf);
        set_box_of_child(node, branch.child, box_of(items));
    }

    NodeBox box_of(std::span<const TreeItem> items) const {
        LatticePoint low = lattice_.vertices[lattice_.faces[items[0].face][0]], high = low;
        for (const TreeItem& item : items)
            for (std::uint32_t vertex : lattice_.faces[item.face]) {
                const LatticePoint& v = lattice_.vertices[vertex];
                low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
                high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
            }
        return {{divided_down(low.x), divided_down(low.y), divided_down(low.z)},
                {divided_up(high.x), divided_up(high.y), divided_up(high.z)}};
    }

    const LatticeMesh& lattice_;
    unsigned thread_count_;
    FaceTree& tree_;
    std::vector<TreeItem> items_;
};

} // namespace

void build_face_tree(const LatticeMesh& lattice, unsigned thread_count, FaceTree& tree) {
    TreeBuilder(lattice, thread_count, tree).build();
}

} // namespace echinus
