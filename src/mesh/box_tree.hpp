#pragma once

#include <echinus/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace echinus {

/// The smallest closed box around a face or several, parallel to the axes.
struct FaceBox {
    Vec3f low, high;

    static FaceBox around(const Vec3f& a, const Vec3f& b, const Vec3f& c);
    static FaceBox around(const FaceBox& a, const FaceBox& b);

    /// Touching counts.
    bool overlaps(const FaceBox& other) const {
        // Without branches: which comparison fails cannot be predicted.
        return (low.x <= other.high.x) & (low.y <= other.high.y) & (low.z <= other.high.z) &
               (other.low.x <= high.x) & (other.low.y <= high.y) & (other.low.z <= high.z);
    }
};

/// A tree of boxes over the faces of a mesh, split at the median of the centroids along the longest side.
class BoxTree {
  public:
    static constexpr std::size_t kLeafSize = 4;

    /// Faces begin to end of the tree's own order. Has no children where there are at most kLeafSize.
    struct Node {
        FaceBox box;
        std::uint32_t begin, end;
        std::uint32_t right; ///< the left child is the next node

        bool is_leaf() const { return end - begin <= kLeafSize; }
        std::uint32_t size() const { return end - begin; }
    };

    struct Leaf {
        FaceBox box;
        std::uint32_t face;
    };

    /// @pre there is a face, indices are in range, vertices finite
    explicit BoxTree(const TriangleMesh& mesh);

    const Node& node(std::uint32_t index) const { return nodes_[index]; }
    const Leaf& leaf(std::uint32_t index) const { return leaves_[index]; }

  private:
    void build(std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

/// Calls visit(face of a, face of b) where their boxes overlap.
template <typename Visit>
void for_each_overlap(const BoxTree& a, std::uint32_t a_index, const BoxTree& b, std::uint32_t b_index,
                      Visit&& visit) {
    const BoxTree::Node &p = a.node(a_index), &q = b.node(b_index);
    if (!p.box.overlaps(q.box)) return;
    if (p.is_leaf() && q.is_leaf()) {
        for (std::uint32_t i = p.begin; i < p.end; ++i)
            for (std::uint32_t j = q.begin; j < q.end; ++j)
                if (a.leaf(i).box.overlaps(b.leaf(j).box)) visit(a.leaf(i).face, b.leaf(j).face);
    } else if (q.is_leaf() || (!p.is_leaf() && p.size() > q.size())) {
        for_each_overlap(a, a_index + 1, b, b_index, visit);
        for_each_overlap(a, p.right, b, b_index, visit);
    } else {
        for_each_overlap(a, a_index, b, b_index + 1, visit);
        for_each_overlap(a, a_index, b, q.right, visit);
    }
}

/// Calls visit(face, face) for the pairs of different faces of one tree whose boxes overlap, each pair once.
template <typename Visit>
void for_each_overlap(const BoxTree& tree, std::uint32_t index, Visit&& visit) {
    const BoxTree::Node& node = tree.node(index);
    if (node.is_leaf()) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            for (std::uint32_t j = i + 1; j < node.end; ++j)
                if (tree.leaf(i).box.overlaps(tree.leaf(j).box)) visit(tree.leaf(i).face, tree.leaf(j).face);
    } else {
        for_each_overlap(tree, index + 1, visit);
        for_each_overlap(tree, node.right, visit);
        for_each_overlap(tree, index + 1, tree, node.right, visit);
    }
}

} // namespace echinus
