#include "exact_map/query/cap_crossings.hpp"

#include "exact_map/query/ray_crossing.hpp"

#include <algorithm>
#include <array>

namespace echinus {

namespace {

constexpr std::size_t kWidth = TreeNode::kWidth;

/// A ray from a particle on, away from the origin.
class OutwardRay {
  public:
    explicit OutwardRay(const LatticePoint& p)
        : from_{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)} {
        // At the origin the ray leads where the perturbation does: first along x.
        const std::array<double, 3> along{p == LatticePoint{} ? 1 : from_[0], from_[1], from_[2]};
        constexpr double kAcross = 1e30; // the inverse of no movement at all along an axis
        for (std::size_t i = 0; i < 3; ++i) inverse_[i] = along[i] == 0 ? kAcross : 1 / along[i];
    }

    /// Which of a node's boxes does it meet? One lattice step around them is more than all of this is
    /// rounded, and than the ray is perturbed.
    std::array<bool, kWidth> meets(const TreeNode& node) const {
        std::array<double, kWidth> begin{}, end;
        end.fill(1e30);
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < kWidth; ++k) {
                const double low = node.low[i][k] * ExactMapView::kBoxUnit - 1;
                const double high = node.high[i][k] * ExactMapView::kBoxUnit + 1;
                const double s = (low - from_[i]) * inverse_[i], t = (high - from_[i]) * inverse_[i];
                begin[k] = std::max(begin[k], std::min(s, t));
                end[k] = std::min(end[k], std::max(s, t));
            }
        }
        std::array<bool, kWidth> result;
        for (std::size_t k = 0; k < kWidth; ++k)
            result[k] = (begin[k] <= end[k]) & (node.low[0][k] <= node.high[0][k]); // is there such a child?
        return result;
    }

  private:
    std::array<double, 3> from_, inverse_{};
};

int crossings_of_leaf(const ExactMapView& map, std::uint32_t leaf, const LatticePoint& p) {
    const CrossingFilter filter(p);
    const IndexArray& corners = map.winding_tree.corners;
    const std::size_t first = leaf * kWidth, last = std::min(first + kWidth, corners.size() / 3);
    int sum = 0;
    for (std::size_t cap = first; cap < last; ++cap) {
        const auto vertex = [&](std::size_t k) { return map.vertices[corners[3 * cap + k]]; };
        const auto a = vertex(0), b = vertex(1), c = vertex(2);
        const auto [crossing, sure] = filter(RaySide::Beyond, &a.x, &b.x, &c.x);
        sum += sure ? crossing
                    : crossing_on(RaySide::Beyond, {LatticePoint(a), LatticePoint(b), LatticePoint(c)}, p);
    }
    return sum;
}

} // namespace

int cap_crossings(const ExactMapView& map, const LatticePoint& p) noexcept {
    const OutwardRay ray(p);
    constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
    std::array<std::uint32_t, kMaxDepth * kWidth> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    int sum = 0;
    while (count > 0) {
        const std::uint32_t child = waiting[--count];
        if ((child & TreeNode::kLeaf) != 0) {
            sum += crossings_of_leaf(map, child - TreeNode::kLeaf, p);
            continue;
        }
        const TreeNode& node = map.winding_tree.nodes[child];
        const std::array<bool, kWidth> met = ray.meets(node);
        for (std::size_t k = 0; k < kWidth; ++k)
            if (met[k]) waiting[count++] = node.children[k];
    }
    return sum;
}

} // namespace echinus
