#include "exact_map/query/nearest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/nearest_faces.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "exact_map/query/face_lanes-inl.hpp"
#include "exact_map/query/one_place-inl.hpp"
#include "geometry/scratch.hpp"
#include "geometry/whole_numbers.hpp"
#include "simd/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

namespace {

std::uint32_t nearest_by_reference(const ExactMapView& map, const Vec3d& stretch,
                                   const NearestSearch& search) {
    return nearest_face(map, search.place, stretch, search.farthest).value_or(kNoFace);
}

/// Would products of lengths leave the range of single precision?
[[maybe_unused]] bool is_too_flat(const Vec3d& stretch) {
    constexpr double kFlattest = 1e-6;
    return std::min({std::fabs(stretch.x), std::fabs(stretch.y), std::fabs(stretch.z)}) < kFlattest;
}

} // namespace

#if HWY_TARGET != HWY_SCALAR

namespace {

/// Performs as many searches as there are lanes in one walk through the tree. Leaves that were visited are
/// kept for the following searches.
class NearestFaceFinder {
  public:
    /// @param all  all searches, at least one
    NearestFaceFinder(const ExactMapView& map, const Vec3d& stretch, std::span<const NearestSearch> all)
        : map_(map), stretch_(stretch), stretch_float_(stretch), origin_(rounded_origin(all.front().place)) {
        for (const NearestSearch& search : all) {
            if (!is_within_range(search)) continue;
            const Vec3d offset = search.place - Vec3d(origin_);
            reach_ = std::max(
                reach_, static_cast<float>(std::fabs(offset.x) + std::fabs(offset.y) + std::fabs(offset.z)));
        }
        leaf_of_slot_.fill(kNoFace);
    }

    /// @param searches  at least one, and no more than there are lanes
    /// @returns  false, and no faces, if a search is out of range or too many faces are about equally near to
    /// be told apart here
    bool find(std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) {
        if (!std::all_of(searches.begin(), searches.end(), is_within_range)) return false;
        start(searches);
        if (!search()) return false;
        candidates_.choose(map_, stretch_, searches, upper_, faces);
        return true;
    }

    static bool is_within_range(const NearestSearch& search) {
        const Vec3d& p = search.place;
        return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}) < kRange;
    }

  private:
    static constexpr double kMaxDistanceSq = 1e30;
    static constexpr std::size_t kMaxLanes = 16;

    /// Places farther from the centre are left to the scalar query.
    static constexpr double kRange = 4 * static_cast<double>(kLatticeExtent);

    static Vec3<std::int32_t> rounded_origin(const Vec3d& place) {
        const auto within = [](double coordinate) {
            return truncated_to<std::int32_t>(std::clamp(coordinate, -kRange, kRange));
        };
        return {within(place.x), within(place.y), within(place.z)};
    }
    static constexpr float kRoundedUp = 1 + 0x1p-20F;

    void start(std::span<const NearestSearch> searches) {
        constexpr Floats f;
        alignas(64) std::array<std::array<float, kMaxLanes>, 4> rows;
        for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
            const NearestSearch& search = searches[std::min(lane, searches.size() - 1)];
            const Vec3d offset = search.place - Vec3d(origin_);
            rows[0][lane] = static_cast<float>(offset.x);
            rows[1][lane] = static_cast<float>(offset.y);
            rows[2][lane] = static_cast<float>(offset.z);
            rows[3][lane] = static_cast<float>(std::min(search.farthest * search.farthest, kMaxDistanceSq));
        }
        flat_ = {hn::Load(f, rows[0].data()), hn::Load(f, rows[1].data()), hn::Load(f, rows[2].data())};
        places_ = times(flat_, splat(stretch_float_));
        upper_ = hn::Mul(hn::Load(f, rows[3].data()), hn::Set(f, kRoundedUp));
        low_ = {least(flat_.x), least(flat_.y), least(flat_.z)};
        high_ = {most(flat_.x), most(flat_.y), most(flat_.z)};
        stretched_low_ = {least(places_.x), least(places_.y), least(places_.z)};
        stretched_high_ = {most(places_.x), most(places_.y), most(places_.z)};
        farthest_upper_ = most(upper_);
        candidates_.clear();
    }

    static float least(FloatLanes v) { return hn::GetLane(hn::MinOfLanes(Floats(), v)); }
    static float most(FloatLanes v) { return hn::GetLane(hn::MaxOfLanes(Floats(), v)); }

    /// A child of a node, and a lower bound of its squared distance from all places.
    struct Waiting {
        float distance; ///< squared
        std::uint32_t node, child;
    };

    /// Returns false if there were too many candidates.
    bool search() {
        const std::uint32_t seed = last_leaf_;
        if (seed != kNoFace && !visit_leaf(seed)) return false;
        std::size_t count = push_children(0, 0);
        while (count > 0) {
            const Waiting next = waiting_[--count];
            if (next.distance > farthest_upper_) continue;
            const std::uint32_t child = map_.nodes[next.node].children[next.child];
            if ((child & TreeNode::kLeaf) == 0) {
                count = push_children(child, count);
                continue;
            }
            const std::uint32_t first =
                (child - TreeNode::kLeaf) * static_cast<std::uint32_t>(TreeNode::kWidth);
            if (first == seed || is_far(next)) continue;
            if (!visit_leaf(first)) return false;
        }
        return true;
    }

    /// Pushes the children that are not too far away, with the nearest on top. Returns how many nodes are
    /// waiting.
    std::size_t push_children(std::uint32_t node, std::size_t count) {
        alignas(32) std::array<float, TreeNode::kWidth> distances_sq;
        measure_children(map_.nodes[node], distances_sq.data());
        const std::size_t before = count;
        for (std::uint32_t child = 0; child < TreeNode::kWidth; ++child) {
            if (distances_sq[child] <= farthest_upper_)
                push_sorted(waiting_.data(), before, count, Waiting{distances_sq[child], node, child});
        }
        return count;
    }

    /// Measures from the box around all places to the boxes of a node's children; far if there is no such
    /// child.
    void measure_children(const TreeNode& node, float* distances_sq) const {
        using Boxes = hn::CappedTag<float, TreeNode::kWidth>;
        constexpr Boxes d;
        constexpr hn::RebindToSigned<Boxes> i;
        constexpr hn::Rebind<std::int16_t, Boxes> shorts;
        const auto unit = hn::Set(d, static_cast<float>(ExactMapView::kBoxUnit));
        for (std::size_t lane = 0; lane < TreeNode::kWidth; lane += hn::Lanes(d)) {
            const auto bound = [&](const std::int16_t* bounds) {
                return hn::Mul(hn::ConvertTo(d, hn::PromoteTo(i, hn::LoadU(shorts, bounds + lane))), unit);
            };
            auto sum = hn::Zero(d);
            const auto add_axis = [&](std::size_t axis, std::int32_t origin, float low, float high,
                                      float stretch) {
                const auto from = hn::Set(d, static_cast<float>(origin));
                const auto child_low = hn::Sub(bound(node.low[axis]), from);
                const auto child_high = hn::Sub(bound(node.high[axis]), from);
                const auto gap =
                    hn::Max(hn::Sub(child_low, hn::Set(d, high)), hn::Sub(hn::Set(d, low), child_high));
                const auto clear =
                    hn::Mul(hn::Max(hn::Sub(gap, hn::Set(d, kBoxSlack)), hn::Zero(d)), hn::Set(d, stretch));
                sum = hn::MulAdd(clear, clear, sum);
            };
            add_axis(0, origin_.x, low_.x, high_.x, stretch_float_.x);
            add_axis(1, origin_.y, low_.y, high_.y, stretch_float_.y);
            add_axis(2, origin_.z, low_.z, high_.z, stretch_float_.z);
            const auto none = hn::Gt(bound(node.low[0]), bound(node.high[0]));
            hn::Store(hn::IfThenElse(none, hn::Set(d, std::numeric_limits<float>::infinity()), sum), d,
                      distances_sq + lane);
        }
    }

    /// Is a box too far from every one of the places?
    bool is_far(const Waiting& waiting) const {
        constexpr Floats f;
        const TreeNode& node = map_.nodes[waiting.node];
        FloatLanes sum = hn::Zero(f);
        const auto add_axis = [&](std::size_t axis, std::int32_t origin, FloatLanes place, float stretch) {
            const auto bound = [&](const std::int16_t(&bounds)[TreeNode::kWidth]) {
                return hn::Set(f,
                               static_cast<float>(bounds[waiting.child] * ExactMapView::kBoxUnit - origin));
            };
            const FloatLanes gap =
                hn::Max(hn::Sub(bound(node.low[axis]), place), hn::Sub(place, bound(node.high[axis])));
            const FloatLanes clear =
                hn::Mul(hn::Max(hn::Sub(gap, hn::Set(f, kBoxSlack)), hn::Zero(f)), hn::Set(f, stretch));
            sum = hn::MulAdd(clear, clear, sum);
        };
        add_axis(0, origin_.x, flat_.x, stretch_float_.x);
        add_axis(1, origin_.y, flat_.y, stretch_float_.y);
        add_axis(2, origin_.z, flat_.z, stretch_float_.z);
        return hn::AllTrue(f, hn::Gt(sum, upper_));
    }

    const LeafLanes& leaf_at(std::uint32_t first, std::uint32_t count) {
        const std::size_t slot = first / TreeNode::kWidth % kKeptLeaves;
        if (leaf_of_slot_[slot] != first) {
            leaf_of_slot_[slot] = first;
            leaves_[slot].prepare(map_, first, count, origin_, stretch_float_, reach_);
        }
        return leaves_[slot];
    }

    bool visit_leaf(std::uint32_t first) {
        constexpr Floats f;
        const auto count = std::min(static_cast<std::uint32_t>(TreeNode::kWidth),
                                    static_cast<std::uint32_t>(map_.face_count()) - first);
        const LeafLanes& leaf = leaf_at(first, count);
        alignas(32) std::array<float, TreeNode::kWidth> distances_sq;
        leaf.distances_sq_to_box(stretched_low_, stretched_high_, distances_sq);
        for (std::uint32_t lane = 0; lane < count; ++lane) {
            if (!(distances_sq[lane] <= farthest_upper_)) continue;
            const auto [lower, upper] = leaf.distances_sq(lane, places_);
            if (hn::AllFalse(f, hn::Le(lower, upper_))) continue;
            if (candidates_.full()) candidates_.keep_within(upper_);
            if (candidates_.full()) return false;
            candidates_.add(first + lane, lower);
            if (!hn::AllFalse(f, hn::Lt(upper, upper_))) last_leaf_ = first;
            upper_ = hn::Min(upper_, upper);
        }
        farthest_upper_ = most(upper_);
        return true;
    }

    static constexpr float kBoxSlack = 1; ///< lattice steps; more than the rounding errors

    const ExactMapView& map_;
    Vec3d stretch_;
    Vec3f stretch_float_;
    std::uint32_t last_leaf_ = kNoFace; ///< first face of the leaf with the nearest faces of the last places

    Vec3<std::int32_t> origin_; ///< on the lattice, near all places
    float reach_ = 0;           ///< no place's L1 distance from it is larger

    // The current places.
    PointLanes flat_ = at_origin(), places_ = at_origin(); ///< before and after stretching
    Vec3f low_, high_;                                     ///< the box around them, before stretching
    Vec3f stretched_low_, stretched_high_;
    FloatLanes upper_;         ///< no place's nearest face has a larger squared distance
    float farthest_upper_ = 0; ///< the largest of those

    static constexpr std::size_t kKeptLeaves = 32;
    std::array<std::uint32_t, kKeptLeaves> leaf_of_slot_; ///< first face of the leaf, or kNoFace
    std::array<LeafLanes, kKeptLeaves> leaves_;

    FaceCandidates candidates_;
    static constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
    std::array<Waiting, kMaxDepth * TreeNode::kWidth> waiting_;
};

/// The L1 distance between the places of a group beyond which separate walks take less time than a shared
/// one. It is ten times the width of a leaf, if the leaves were spread over the sphere: measured on meshes of
/// 3000 to 52 000 faces, where factors from 5 to 10 made little difference.
double sharing_distance(const ExactMapView& map) {
    constexpr double kLeaves = 10;
    const double leaf_count = static_cast<double>(map.face_count()) / TreeNode::kWidth;
    return kLeaves * static_cast<double>(kLatticeExtent) / std::sqrt(leaf_count);
}

/// @param distance  the distance of a nearby place from the surface: from afar, places see the same faces
///                  first
bool pays_to_share(std::span<const NearestSearch> group, double farthest_apart, double distance) {
    if (group.size() < hn::Lanes(Floats()) / 2) return false;
    Vec3d low = group[0].place, high = low;
    for (const NearestSearch& search : group) {
        const Vec3d& p = search.place;
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const Vec3d apart = high - low;
    return apart.x + apart.y + apart.z <= farthest_apart + distance;
}

template <typename Measure>
std::uint32_t find_one(const ExactMapView& map, const Measure& measure, const NearestSearch& search,
                       float limit) {
    const std::uint32_t near_leaf =
        search.near_leaf != kNoLeaf ? search.near_leaf : leaf_near(map, search.place);
    return OnePlaceSearch(map, measure).find(near_leaf, limit, search.farthest * search.farthest);
}

std::uint32_t search_alone(const ExactMapView& map, const Vec3d& stretch, const NearestSearch& search) {
    if (map.face_count() < TreeNode::kWidth || is_too_flat(stretch))
        return nearest_by_reference(map, stretch, search);
    if (stretch == Vec3d{1, 1, 1} && FacesFromAfar::is_for(search))
        return find_one(map, AfarMeasure(search.place), search, AfarMeasure::kFarthest);
    if (!NearestFaceFinder::is_within_range(search)) return nearest_by_reference(map, stretch, search);
    return find_one(map, NearMeasure(search.place, stretch), search,
                    NearMeasure::limit(search.farthest * search.farthest));
}

} // namespace

std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch, const NearestSearch& search) {
    return search_alone(map, stretch, search);
}

void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) {
    if (searches.empty()) return;
    if (is_too_flat(stretch)) {
        for (std::size_t i = 0; i < searches.size(); ++i)
            faces[i] = nearest_by_reference(map, stretch, searches[i]);
        return;
    }
    const std::size_t lanes = hn::Lanes(Floats());
    const double farthest_apart = sharing_distance(map);
    double distance = 0; // of the previous place
    const auto find_with = [&](auto& finder) {
        for (std::size_t begin = 0; begin < searches.size(); begin += lanes) {
            const std::size_t count = std::min(lanes, searches.size() - begin);
            const auto group = searches.subspan(begin, count);
            const auto found = faces.subspan(begin, count);
            if (!pays_to_share(group, farthest_apart, distance) || !finder.find(group, found))
                for (std::size_t i = 0; i < count; ++i) found[i] = search_alone(map, stretch, group[i]);
            if (found.back() != kNoFace)
                distance = std::sqrt(distance_sq_to_face(map, found.back(), group.back().place, stretch));
        }
    };
    const bool unstretched = stretch == Vec3d{1, 1, 1};
    if (unstretched && std::all_of(searches.begin(), searches.end(), FacesFromAfar::is_for)) {
        find_with(*OnScratch<FacesFromAfar>(map));
    } else {
        find_with(*OnScratch<NearestFaceFinder>(map, stretch, searches));
    }
}

#else

std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch, const NearestSearch& search) {
    return nearest_by_reference(map, stretch, search);
}

void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) {
    for (std::size_t i = 0; i < searches.size(); ++i)
        faces[i] = nearest_by_reference(map, stretch, searches[i]);
}

#endif

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(find_nearest_face);
HWY_EXPORT(find_nearest_faces);

} // namespace

std::uint32_t find_nearest_face(const ExactMapView& map, const Vec3d& stretch,
                                const NearestSearch& search) noexcept {
    return ECHINUS_DISPATCH(find_nearest_face)(map, stretch, search);
}

void find_nearest_faces(const ExactMapView& map, const Vec3d& stretch,
                        std::span<const NearestSearch> searches, std::span<std::uint32_t> faces) noexcept {
    assert(searches.size() == faces.size());
    ECHINUS_DISPATCH(find_nearest_faces)(map, stretch, searches, faces);
}

} // namespace echinus
#endif
