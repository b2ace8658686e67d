// Included once for each instruction set, as Highway wants it: no guard against a second time.
#if defined(ECHINUS_AFAR_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_AFAR_LANES_INL
#undef ECHINUS_AFAR_LANES_INL
#else
#define ECHINUS_AFAR_LANES_INL
#endif

#include "exact_map/query/face_candidates-inl.hpp"
#include "exact_map/query/face_tree_walk.hpp"
#include "exact_map/query/nearest.hpp"
#include "simd/lanes-inl.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#if HWY_TARGET != HWY_SCALAR // where the reference is used instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// nearest_face() of as many places afar as there are lanes, in one walk through the tree. Compares the
/// excess that nearest.cpp explains, in single precision.
///
/// On a triangle the excess is least at a corner, but for its square term: with edges no longer than s that
/// takes off at most s^2 / 2 d.
class FacesFromAfar {
  public:
    explicit FacesFromAfar(const ExactMapView& map) : map_(map) {}

    /// Are these lanes for this search? A bounded one needs the scalar query's comparison.
    static bool is_for(const NearestSearch& search) {
        return is_afar(search.place) && !std::isfinite(search.farthest);
    }

    /// @param searches  one at least, and no more than there are lanes; is_for() holds
    /// @returns  false, and no faces, where too many faces are about equally near to be told apart together
    bool find(std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) {
        std::array<NearestSearch, kMaxLanes> near;
        for (std::size_t i = 0; i < searches.size(); ++i)
            near[i] = {brought_within_reach(searches[i].place), searches[i].farthest};
        const std::span<const NearestSearch> asked(near.data(), searches.size());
        start(asked);
        if (!walk()) return false;
        candidates_.choose(map_, kUnstretched, asked, upper_, faces);
        return true;
    }

  private:
    static constexpr std::size_t kMaxLanes = 16;
    static constexpr Vec3d kUnstretched{1, 1, 1};
    static constexpr float kSlack = 1; ///< lattice steps, more than is rounded
    static constexpr float kFar = 1e30F;

    void start(std::span<const NearestSearch> searches) {
        constexpr Floats f;
        alignas(64) std::array<std::array<float, kMaxLanes>, 7> rows;
        for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
            const Vec3d& place = searches[std::min(lane, searches.size() - 1)].place;
            const double distance = length(place);
            const Vec3f at(place), direction(place * (1 / distance));
            rows[0][lane] = at.x;
            rows[1][lane] = at.y;
            rows[2][lane] = at.z;
            rows[3][lane] = direction.x;
            rows[4][lane] = direction.y;
            rows[5][lane] = direction.z;
            rows[6][lane] = static_cast<float>(0.5 / distance);
        }
        places_ = {hn::Load(f, rows[0].data()), hn::Load(f, rows[1].data()), hn::Load(f, rows[2].data())};
        directions_ = {hn::Load(f, rows[3].data()), hn::Load(f, rows[4].data()), hn::Load(f, rows[5].data())};
        curvatures_ = hn::Load(f, rows[6].data());
        upper_ = hn::Set(f, kFar);
        candidates_.clear();
    }

    struct Waiting {
        float distance; ///< the lowest excess of all places; to sort by
        std::uint32_t node, child;
    };

    /// Returns false where the candidates became too many.
    bool walk() {
        std::size_t count = push_children(0, 0);
        while (count > 0) {
            const Waiting next = waiting_[--count];
            if (!is_near(box_excess(map_.nodes[next.node], next.child))) continue;
            const std::uint32_t child = map_.nodes[next.node].children[next.child];
            if ((child & TreeNode::kLeaf) == 0)
                count = push_children(child, count);
            else if (!visit_leaf((child - TreeNode::kLeaf) * static_cast<std::uint32_t>(TreeNode::kWidth)))
                return false;
        }
        return true;
    }

    bool is_near(FloatLanes excess) const { return !hn::AllTrue(Floats(), hn::Gt(excess, upper_)); }

    std::size_t push_children(std::uint32_t number, std::size_t count) {
        const TreeNode& node = map_.nodes[number];
        const std::size_t before = count;
        for (std::uint32_t child = 0; child < TreeNode::kWidth; ++child) {
            if (node.low[0][child] > node.high[0][child]) continue; // there is none
            const FloatLanes excess = box_excess(node, child);
            if (!is_near(excess)) continue;
            const float least = hn::GetLane(hn::MinOfLanes(Floats(), excess));
            push_sorted(waiting_.data(), before, count, Waiting{least, number, child});
        }
        return count;
    }

    /// Lower bounds in a box.
    FloatLanes box_excess(const TreeNode& node, std::uint32_t child) const {
        constexpr Floats f;
        const auto along_axis = [&](std::size_t axis, FloatLanes place, FloatLanes direction) HWY_ATTR {
            const auto bound = [&](std::int16_t units) HWY_ATTR {
                return hn::Set(f, static_cast<float>(units * ExactMapView::kBoxUnit));
            };
            const FloatLanes q =
                hn::Min(hn::Max(place, bound(node.low[axis][child])), bound(node.high[axis][child]));
            return hn::Mul(q, hn::MulSub(q, curvatures_, direction));
        };
        const FloatLanes sum =
            hn::Add(hn::Add(along_axis(0, places_.x, directions_.x), along_axis(1, places_.y, directions_.y)),
                    along_axis(2, places_.z, directions_.z));
        return hn::Sub(sum, hn::Set(f, kSlack));
    }

    bool visit_leaf(std::uint32_t first) {
        constexpr Floats f;
        const auto count = std::min(static_cast<std::uint32_t>(TreeNode::kWidth),
                                    static_cast<std::uint32_t>(map_.face_count()) - first);
        for (std::uint32_t face = first; face < first + count; ++face) {
            FloatLanes least = hn::Set(f, kFar);
            std::array<Vec3f, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = Vec3f(map_.vertices[map_.corners[3 * std::size_t{face} + k]]);
                const PointLanes q = splat(corners[k]);
                least = hn::Min(least, hn::MulSub(fused_dot(q, q), curvatures_, fused_dot(q, directions_)));
            }
            const Vec3f ab = corners[1] - corners[0], bc = corners[2] - corners[1],
                        ca = corners[0] - corners[2];
            const float edge_sq = std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)});
            const FloatLanes lower =
                hn::Sub(hn::NegMulAdd(hn::Set(f, edge_sq), curvatures_, least), hn::Set(f, kSlack));
            if (!is_near(lower)) continue;
            if (candidates_.full()) candidates_.keep_within(upper_);
            if (candidates_.full()) return false;
            candidates_.add(face, lower);
            upper_ = hn::Min(upper_, hn::Add(least, hn::Set(f, kSlack)));
        }
        return true;
    }

    const ExactMapView& map_;
    PointLanes places_ = at_origin(), directions_ = at_origin();
    FloatLanes curvatures_; ///< 1 / 2 d
    FloatLanes upper_;      ///< the excess of the nearest face of each surely lies within it

    FaceCandidates candidates_;
    static constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
    std::array<Waiting, kMaxDepth * TreeNode::kWidth> waiting_;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
