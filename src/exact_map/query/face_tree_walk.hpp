#pragma once

#include <echinus/exact_map_view.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace echinus {

/// How far something is from each child of a node; larger than any bound where there is no child.
using ChildDistances = std::array<float, TreeNode::kWidth>;

/// The faces of a leaf, half open.
struct LeafFaces {
    std::uint32_t first, last;
};

/// Pushes onto a stack whose entries from `sorted` on are sorted, the nearest on top, and keeps them so.
template <typename Entry>
void push_sorted(Entry* stack, std::size_t sorted, std::size_t& count, const Entry& entry) {
    std::size_t place = count++;
    for (; place > sorted && stack[place - 1].distance < entry.distance; --place)
        stack[place] = stack[place - 1];
    stack[place] = entry;
}

/// Branch and bound: calls visit(LeafFaces) for the leaves that are not beyond `bound`, near ones first.
/// Stops when what is left lies beyond the bound, which `visit` may lower.
/// @param measure  ChildDistances measure(node): lower bounds of the distance in any unit
template <typename Measure, typename Visit>
void walk_near_leaves(const ExactMapView& map, const float& bound, const Measure& measure,
                      const Visit& visit) {
    struct Waiting {
        std::uint32_t child;
        float distance;
    };
    // validate() and the builder keep trees to this depth; at each level all children but one may wait.
    constexpr std::size_t kMaxDepth = 12;
    std::array<Waiting, kMaxDepth * TreeNode::kWidth> waiting;
    std::size_t count = 0;
    waiting[count++] = {0, 0};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.distance > bound) continue;
        if ((next.child & TreeNode::kLeaf) != 0) {
            const std::uint32_t first =
                (next.child - TreeNode::kLeaf) * static_cast<std::uint32_t>(TreeNode::kWidth);
            visit(LeafFaces{first, std::min(first + static_cast<std::uint32_t>(TreeNode::kWidth),
                                            static_cast<std::uint32_t>(map.face_count()))});
            continue;
        }
        const TreeNode& node = map.nodes[next.child];
        const ChildDistances distances = measure(node);
        const std::size_t before = count;
        for (std::size_t k = 0; k < TreeNode::kWidth; ++k) {
            if (distances[k] <= bound)
                push_sorted(waiting.data(), before, count, Waiting{node.children[k], distances[k]});
        }
    }
}

} // namespace echinus
