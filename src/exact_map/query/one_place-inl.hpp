// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_ONE_PLACE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_ONE_PLACE_INL
#undef ECHINUS_ONE_PLACE_INL
#else
#define ECHINUS_ONE_PLACE_INL
#endif

#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "geometry/whole_numbers.hpp"
#include "simd/compress-inl.hpp"
#include "simd/lanes-inl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#if HWY_TARGET != HWY_SCALAR // HWY_SCALAR uses the reference instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// One lane for each box of a node or face of a leaf, or for half of them if vectors are short.
using Eight = hn::CappedTag<float, TreeNode::kWidth>;
using EightLanes = hn::Vec<Eight>;
using EightPoints = Vec3Lanes<EightLanes>;

HWY_INLINE EightLanes eight(float value) {
    return hn::Set(Eight(), value);
}
HWY_INLINE EightPoints eight(const Vec3f& v) {
    return {eight(v.x), eight(v.y), eight(v.z)};
}

using EightNumbers = hn::RebindToSigned<Eight>;

/// Lattice points.
using EightPlaces = Vec3Lanes<hn::Vec<EightNumbers>>;

HWY_INLINE EightPoints as_floats(const EightPlaces& v) {
    return {hn::ConvertTo(Eight(), v.x), hn::ConvertTo(Eight(), v.y), hn::ConvertTo(Eight(), v.z)};
}

/// Limits of some boxes of a node along an axis, in the units of boxes.
HWY_INLINE hn::Vec<EightNumbers> box_numbers(const std::int16_t* limits) {
    return hn::PromoteTo(EightNumbers(), hn::LoadU(hn::Rebind<std::int16_t, Eight>(), limits));
}
HWY_INLINE EightLanes box_limits(const std::int16_t* limits) {
    return hn::ConvertTo(Eight(), box_numbers(limits));
}

HWY_INLINE hn::Mask<EightNumbers> boxes_that_exist(const TreeNode& node, std::size_t first) {
    return hn::Lt(box_numbers(node.low[0] + first),
                  hn::Add(box_numbers(node.high[0] + first), hn::Set(EightNumbers(), 1)));
}

/// Bounds of the distances of some faces, in a unit that grows with the distance.
struct FaceBounds {
    EightLanes lower, upper;
};

/// Squared distances of a place on the lattice or near it.
class NearMeasure {
  public:
    NearMeasure(const Vec3d& place, const Vec3d& stretch)
        : place_(place), exact_stretch_(stretch), origin_(rounded(place)), stretch_(stretch),
          offset_(place - Vec3d(origin_)) {
        constexpr float kPerUnit = 1.0F / ExactMapView::kBoxUnit;
        const Vec3f in_units = Vec3f(place) * kPerUnit;
        const Vec3f slack{kPerUnit, kPerUnit, kPerUnit}; // one step: more than the rounding errors
        above_ = in_units + slack;
        below_ = in_units - slack;
        per_unit_ = Vec3f(Vec3d{std::fabs(stretch.x), std::fabs(stretch.y), std::fabs(stretch.z)}) *
                    static_cast<float>(ExactMapView::kBoxUnit);
    }

    static constexpr float kFarthest = 1e30F;
    /// A limit above all squared distances up to this one.
    static float limit(double farthest_sq) {
        return static_cast<float>(std::min(farthest_sq, double{kFarthest})) * (1 + 0x1p-20F);
    }
    float limit_by(double distance_sq) const { return limit(distance_sq); }
    /// The squared distance that a leaf near the place's ray likely keeps to the place, too: the square of
    /// twice the width of a leaf, if the leaves were spread over the sphere.
    static float close_by(const ExactMapView& map) {
        constexpr auto kExtent = static_cast<float>(kLatticeExtent);
        return 32 * kExtent * kExtent / static_cast<float>(map.face_count());
    }

    /// The squared distance by which nearest_face() compares faces.
    double distance_sq(const ExactMapView& map, std::uint32_t face) const {
        return distance_sq_to_face(map, face, place_, exact_stretch_);
    }

    /// Lower bounds of the squared distances of boxes.
    HWY_INLINE EightLanes boxes(const TreeNode& node, std::size_t first) const {
        const auto clear = [&](std::size_t axis, float above, float below, float unit) HWY_ATTR {
            const EightLanes low = hn::Sub(box_limits(node.low[axis] + first), eight(above));
            const EightLanes high = hn::Sub(eight(below), box_limits(node.high[axis] + first));
            return hn::Mul(hn::Max(hn::Max(low, high), hn::Zero(Eight())), eight(unit));
        };
        const EightPoints gap{clear(0, above_.x, below_.x, per_unit_.x),
                              clear(1, above_.y, below_.y, per_unit_.y),
                              clear(2, above_.z, below_.z, per_unit_.z)};
        return fused_dot(gap, gap);
    }

    /// Sets the distance beyond which within() may leave out boxes.
    void set_reach(float limit) {
        const float reach = std::sqrt(limit);
        const auto set = [&](float above, float below, float unit, std::int32_t& low, std::int32_t& high) {
            constexpr float kLowest = -32767, kHighest = 32766; // between the limits of a missing child
            const float units = unit > 0 ? reach / unit : kHighest;
            high = truncated_to<std::int32_t>(std::min(above + units + 1, kHighest));
            low = truncated_to<std::int32_t>(std::max(below - units - 1, kLowest));
        };
        set(above_.x, below_.x, per_unit_.x, reach_low_.x, reach_high_.x);
        set(above_.y, below_.y, per_unit_.y, reach_low_.y, reach_high_.y);
        set(above_.z, below_.z, per_unit_.z, reach_low_.z, reach_high_.z);
    }

    /// The boxes that meet the box around everything within reach. Computed in integers, which takes a third
    /// of the time of a distance.
    HWY_INLINE hn::Mask<EightNumbers> within(const TreeNode& node, std::size_t first) const {
        constexpr EightNumbers i;
        const auto gap = [&](std::size_t axis, std::int32_t low, std::int32_t high) HWY_ATTR {
            return hn::Max(hn::Sub(box_numbers(node.low[axis] + first), hn::Set(i, high)),
                           hn::Sub(hn::Set(i, low), box_numbers(node.high[axis] + first)));
        };
        const auto largest =
            hn::Max(hn::Max(gap(0, reach_low_.x, reach_high_.x), gap(1, reach_low_.y, reach_high_.y)),
                    gap(2, reach_low_.z, reach_high_.z));
        return hn::Lt(largest, hn::Set(i, 1));
    }

    /// @param corner_a, b, c  on the lattice
    ///
    /// With edges u = b - a and v = c - a, everything follows from the products of a, u and v; the place's
    /// projection onto the plane is a + (s u + t v) / (u x v)^2.
    ///
    /// Rounding. Edges and a are off by no more than one rounding, e = 2^-24. Let m be the largest distance
    /// of a corner: products with a are off by 4 e m |u| and the like, squared distances from edges by 54 e
    /// m^2, and those from the plane by 60 e q^2 m^2, with q = |u| |v| / |u x v|. If rounding makes a
    /// projection just outside the face count as inside, the square of its distance from the face is missing:
    /// less than 1600 e^2 q^4 m^2, which is 6 e m^2 where the plane is used. The code below allows for 2^7 e
    /// q^2 m^2, with 2 (a^2 + u^2 + v^2) in place of m^2.
    HWY_INLINE FaceBounds faces(const EightPlaces& corner_a, const EightPlaces& b,
                                const EightPlaces& c) const {
        constexpr float kThin = 256; // limit of q^2 beyond which this method fails
        const EightPoints stretch = eight(stretch_);
        const EightPoints u = times(as_floats(b - corner_a), stretch);
        const EightPoints v = times(as_floats(c - corner_a), stretch);
        const EightPoints from_origin = as_floats(corner_a - EightPlaces{hn::Set(EightNumbers(), origin_.x),
                                                                         hn::Set(EightNumbers(), origin_.y),
                                                                         hn::Set(EightNumbers(), origin_.z)});
        const EightPoints a = times(from_origin - eight(offset_), stretch);
        const EightLanes aa = fused_dot(a, a), uu = fused_dot(u, u), vv = fused_dot(v, v);
        const EightLanes uv = fused_dot(u, v), au = fused_dot(a, u), av = fused_dot(a, v);
        const EightLanes across_sq = hn::MulSub(uu, vv, hn::Mul(uv, uv)), sides_sq = hn::Mul(uu, vv);
        const auto is_wide = hn::Lt(sides_sq, hn::Mul(across_sq, eight(kThin)));
        if (!hn::AllTrue(Eight(), is_wide)) [[unlikely]]
            return thin_faces(a, a + u, a + v);
        const EightLanes inverse_sq = hn::Div(eight(1), across_sq);

        const EightLanes s = hn::MulSub(uv, av, hn::Mul(vv, au)), t = hn::MulSub(uv, au, hn::Mul(uu, av));
        const EightLanes rest = hn::Sub(hn::Sub(across_sq, s), t);
        const EightLanes to_plane = hn::MulAdd(hn::MulAdd(s, au, hn::Mul(t, av)), inverse_sq, aa);

        const EightLanes aa_uu = hn::Add(aa, uu);
        const EightLanes bb = hn::Add(aa_uu, hn::Add(au, au)),
                         bc_sq = hn::Sub(hn::Add(uu, vv), hn::Add(uv, uv));
        const EightLanes b_bc = hn::Add(hn::Sub(av, au), hn::Sub(uv, uu));
        const EightLanes to_edges =
            hn::Min(hn::Min(to_edge_sq(aa, au, uu), to_edge_sq(aa, av, vv)), to_edge_sq(bb, b_bc, bc_sq));
        const auto above = hn::Gt(hn::Min(hn::Min(s, t), rest), hn::Zero(Eight()));
        const EightLanes distance_sq = hn::IfThenElse(above, to_plane, to_edges);
        const EightLanes q_sq = hn::Max(hn::Mul(sides_sq, inverse_sq), eight(1));
        const EightLanes error = hn::Mul(hn::Mul(hn::Add(aa_uu, vv), eight(0x1p-16F)), q_sq);
        return {hn::Sub(distance_sq, error), hn::Add(distance_sq, error)};
    }

  private:
    /// The squared distance from an edge, by products of its start with itself and with the edge.
    static HWY_INLINE EightLanes to_edge_sq(EightLanes start_sq, EightLanes along, EightLanes edge_sq) {
        const EightLanes back =
            hn::Min(hn::Max(hn::Div(along, edge_sq), eight(-1)), hn::Zero(Eight())); // the negative fraction
        return hn::NegMulAdd(back, hn::NegMulAdd(back, edge_sq, hn::Add(along, along)), start_sq);
    }

    /// The same bounds, also for faces so thin that their planes are ill-determined, and for segments and
    /// points. The rounding is that of LeafLanes, with the place as origin.
    HWY_NOINLINE FaceBounds thin_faces(const EightPoints& a, const EightPoints& b,
                                       const EightPoints& c) const {
        constexpr float kThin = 1024;                        // as in LeafLanes
        const auto inverse = [](EightLanes value) HWY_ATTR { // 0 for 0
            return hn::IfThenElseZero(hn::Gt(value, hn::Zero(Eight())), hn::Div(eight(1), value));
        };
        const auto to_edge_sq = [&](const EightPoints& start, const EightPoints& edge,
                                    EightLanes length_sq) HWY_ATTR {
            const EightLanes back = hn::Mul(fused_dot(start, edge), inverse(length_sq));
            const EightLanes share = hn::Min(hn::Max(hn::Neg(back), hn::Zero(Eight())), eight(1));
            const EightPoints nearest{hn::MulAdd(edge.x, share, start.x), hn::MulAdd(edge.y, share, start.y),
                                      hn::MulAdd(edge.z, share, start.z)};
            return fused_dot(nearest, nearest);
        };
        const EightPoints ab = b - a, bc = c - b, ca = a - c, normal = fused_cross(ab, bc);
        const EightLanes ab_sq = fused_dot(ab, ab), bc_sq = fused_dot(bc, bc), ca_sq = fused_dot(ca, ca);
        const EightLanes normal_sq = fused_dot(normal, normal), normal_inverse = inverse(normal_sq);
        const EightLanes sides_sq = // squared product of the two longest; they meet at the sharpest corner
            hn::Max(hn::Max(hn::Mul(ab_sq, bc_sq), hn::Mul(bc_sq, ca_sq)), hn::Mul(ca_sq, ab_sq));
        const auto has_plane = hn::Lt(sides_sq, hn::Mul(normal_sq, eight(kThin)));
        const EightLanes past_ab = fused_dot(a, fused_cross(ab, normal));
        const EightLanes past_bc = fused_dot(b, fused_cross(bc, normal));
        const EightLanes past_ca = fused_dot(c, fused_cross(ca, normal));
        const auto above =
            hn::And(has_plane, hn::Gt(hn::Min(hn::Min(past_ab, past_bc), past_ca), hn::Zero(Eight())));
        const EightLanes height = fused_dot(a, normal);
        const EightLanes to_plane = hn::Mul(hn::Mul(height, height), normal_inverse);
        const EightLanes to_edges =
            hn::Min(hn::Min(to_edge_sq(a, ab, ab_sq), to_edge_sq(b, bc, bc_sq)), to_edge_sq(c, ca, ca_sq));
        const EightLanes distance_sq = hn::IfThenElse(above, to_plane, to_edges);

        constexpr float kOffset = 8; // the place is nearer than this to its lattice point
        const EightLanes scale =
            hn::Add(hn::Add(l1_norm(a), l1_norm(b)), hn::Add(l1_norm(c), eight(kOffset)));
        const EightLanes error_sq = hn::Mul(hn::Mul(scale, scale), eight(0x1p-23F));
        const EightLanes of_plane = hn::Mul(error_sq, hn::Max(hn::Mul(sides_sq, normal_inverse), eight(1)));
        const EightLanes width_sq = hn::Mul(normal_sq, inverse(hn::Max(hn::Max(ab_sq, bc_sq), ca_sq)));
        const EightLanes upper_term = hn::IfThenElse(has_plane, of_plane, error_sq);
        const EightLanes lower_term =
            hn::IfThenElse(has_plane, of_plane, hn::MulAdd(width_sq, eight(1.01F), error_sq));
        const EightLanes lower_factor =
            hn::IfThenElse(has_plane, eight(1 - 0x1p-12F), eight((1 - 0x1p-12F) / 2));
        return {hn::MulSub(distance_sq, lower_factor, lower_term),
                hn::MulAdd(distance_sq, eight(1 + 0x1p-12F), upper_term)};
    }

    Vec3d place_, exact_stretch_;
    Vec3<std::int32_t> origin_; ///< the lattice point nearest to the place
    Vec3f stretch_, offset_;    ///< stretch; the place relative to the origin
    Vec3f above_, below_;       ///< slightly more and slightly less than the place; in the unit of boxes
    Vec3f per_unit_;            ///< the stretched unit of boxes, in lattice steps
    Vec3<std::int32_t> reach_low_, reach_high_; ///< box around all within reach, in the unit of boxes
};

/// Measures from a distant place by the excess that nearest.cpp explains. On a triangle it is least at a
/// corner, except for its square term, which lowers it by at most s^2 / 2 d if the edges are no longer than
/// s.
class AfarMeasure {
  public:
    explicit AfarMeasure(const Vec3d& place)
        : place_(brought_within_reach(place)), distance_(length(place_)), at_(place_),
          direction_(place_ * (1 / distance_)), curvature_(static_cast<float>(0.5 / distance_)) {}

    static constexpr float kFarthest = 1e30F;
    float limit_by(double distance_sq) const {
        return static_cast<float>((distance_sq - distance_ * distance_) / (2 * distance_)) + kSlack;
    }

    /// No leaf counts as close by.
    static float close_by(const ExactMapView& /*map*/) { return -kFarthest; }

    double distance_sq(const ExactMapView& map, std::uint32_t face) const {
        return distance_sq_to_face(map, face, place_, {1, 1, 1});
    }

    HWY_INLINE EightLanes boxes(const TreeNode& node, std::size_t first) const {
        const auto least = [&](std::size_t axis, float at, float direction) HWY_ATTR {
            const EightLanes unit = eight(ExactMapView::kBoxUnit);
            const EightLanes low = hn::Mul(box_limits(node.low[axis] + first), unit);
            const EightLanes high = hn::Mul(box_limits(node.high[axis] + first), unit);
            return excess(hn::Min(hn::Max(eight(at), low), high), direction);
        };
        return hn::Sub(hn::Add(hn::Add(least(0, at_.x, direction_.x), least(1, at_.y, direction_.y)),
                               least(2, at_.z, direction_.z)),
                       eight(kSlack));
    }

    void set_reach(float limit) { reach_ = limit; }
    HWY_INLINE hn::Mask<EightNumbers> within(const TreeNode& node, std::size_t first) const {
        const auto near = hn::RebindMask(EightNumbers(), hn::Le(boxes(node, first), eight(reach_)));
        return hn::And(near, boxes_that_exist(node, first));
    }

    HWY_INLINE FaceBounds faces(const EightPlaces& corner_a, const EightPlaces& corner_b,
                                const EightPlaces& corner_c) const {
        const EightPoints a = as_floats(corner_a), b = as_floats(corner_b), c = as_floats(corner_c);
        const EightLanes least = hn::Min(hn::Min(excess(a), excess(b)), excess(c));
        const EightPoints ab = b - a, bc = c - b, ca = a - c;
        const EightLanes edge_sq = hn::Max(hn::Max(fused_dot(ab, ab), fused_dot(bc, bc)), fused_dot(ca, ca));
        return {hn::Sub(hn::NegMulAdd(edge_sq, eight(curvature_), least), eight(kSlack)),
                hn::Add(least, eight(kSlack))};
    }

  private:
    static constexpr float kSlack = 1; ///< lattice steps; more than the rounding errors

    HWY_INLINE EightLanes excess(EightLanes coordinate, float direction) const {
        return hn::Mul(coordinate, hn::MulSub(coordinate, eight(curvature_), eight(direction)));
    }
    HWY_INLINE EightLanes excess(const EightPoints& q) const {
        return hn::MulSub(fused_dot(q, q), eight(curvature_), fused_dot(q, eight(direction_)));
    }

    Vec3d place_;
    double distance_; ///< from the centre
    Vec3f at_, direction_;
    float curvature_; ///< 1 / 2 d
    float reach_ = 0;
};

/// Moves the chosen lanes to the beginning; the lanes after them are arbitrary.
class EightCompressor {
  public:
    using Numbers = EightNumbers;
    explicit EightCompressor(hn::Mask<Numbers> chosen)
#if HWY_TARGET == HWY_AVX3 // for which Ints are wider
        : chosen_(chosen) {
    }
    std::size_t count() const {
        return hn::CountTrue(Numbers(), chosen_);
    }
    hn::Vec<Numbers> operator()(hn::Vec<Numbers> lanes) const {
        return hn::Compress(lanes, chosen_);
    }

  private:
    hn::Mask<Numbers> chosen_;
#else
        : compress_(chosen) {
    }
    std::size_t count() const {
        return compress_.count();
    }
    hn::Vec<Numbers> operator()(hn::Vec<Numbers> lanes) const {
        return compress_(lanes);
    }

  private:
    Compressor compress_;
#endif
};

/// nearest_face() of one place: the lanes are the boxes of a node or the faces of a leaf, so it needs no
/// neighbouring places.
///
/// A first leaf gives a bound, which is good if that leaf is near. The leaves within the bound are listed,
/// without a branch that depends on the boxes, and then visited, nearest first.
/// @pre the map has enough faces to fill a leaf
template <typename Measure>
class OnePlaceSearch {
  public:
    OnePlaceSearch(const ExactMapView& map, const Measure& measure) : map_(map), measure_(measure) {}

    /// @param near_leaf    the leaf to begin with, or kNoLeaf
    /// @param limit        bound in the unit of the measure; everything beyond it is certainly farther than
    ///               `farthest_sq`
    /// @param farthest_sq  squared distance; may be infinite
    std::uint32_t find(std::uint32_t near_leaf, float limit, double farthest_sq) {
        upper_ = limit;
        nearest_sq_ = farthest_sq;
        first_leaf_ = near_leaf == kNoLeaf ? kNoLeaf : TreeNode::kLeaf + near_leaf;
        if (near_leaf != kNoLeaf) visit_leaf(near_leaf);
        if (!(upper_ < measure_.close_by(map_))) visit_leaf_by_descent();
        measure_.set_reach(upper_);
        node_count_ = 1;
        nodes_[0] = 0;
        while (node_count_ > 0) {
            const TreeNode& node = map_.nodes[nodes_[--node_count_]];
            if ((node.children[0] & TreeNode::kLeaf) != 0)
                list_leaves(node);
            else
                list_children(node);
            if (leaves_.size > kLeafCapacity - kWidth) {
                visit_leaves();
                measure_.set_reach(upper_);
            }
        }
        visit_leaves();
        return choose();
    }

  private:
    static constexpr std::size_t kWidth = TreeNode::kWidth, kLeafCapacity = 32;
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    using Numbers = EightNumbers;
    using Unsigned = hn::RebindToUnsigned<Eight>;

    /// Leaves and their distances. Stores write a whole vector, of which only the first lanes count.
    struct Leaves {
        std::size_t size = 0;
        std::array<float, kLeafCapacity + kWidth> distances;
        std::array<std::uint32_t, kLeafCapacity + kWidth> children;

        HWY_INLINE void add(hn::Mask<Numbers> chosen, EightLanes lower, hn::Vec<Numbers> numbers) {
            const EightCompressor compress(chosen);
            hn::StoreU(hn::BitCast(Eight(), compress(hn::BitCast(Numbers(), lower))), Eight(),
                       &distances[size]);
            hn::StoreU(hn::BitCast(Unsigned(), compress(numbers)), Unsigned(), &children[size]);
            size += compress.count();
        }
    };

    static HWY_INLINE hn::Vec<Numbers> children_of(const TreeNode& node, std::size_t first) {
        return hn::BitCast(Numbers(), hn::LoadU(Unsigned(), node.children + first));
    }

    void push_nodes(hn::Mask<Numbers> chosen, hn::Vec<Numbers> children) {
        const EightCompressor compress(chosen);
        hn::StoreU(hn::BitCast(Unsigned(), compress(children)), Unsigned(), &nodes_[node_count_]);
        node_count_ += compress.count();
    }

    /// Lists the children of a node whose children are mostly nodes.
    HWY_INLINE void list_children(const TreeNode& node) {
        for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(Eight())) {
            const auto children = children_of(node, lane);
            const auto near = measure_.within(node, lane);
            const auto leaves = hn::And(near, hn::Lt(children, hn::Zero(Numbers())));
            push_nodes(hn::AndNot(leaves, near), children);
            if (!hn::AllFalse(Numbers(), leaves)) [[unlikely]]
                leaves_.add(leaves, measure_.boxes(node, lane), children);
        }
    }

    /// Lists the children of a node whose children are mostly leaves.
    HWY_INLINE void list_leaves(const TreeNode& node) {
        constexpr Numbers n;
        for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(Eight())) {
            const auto children = children_of(node, lane);
            const EightLanes lower = measure_.boxes(node, lane);
            const auto near =
                hn::And(hn::RebindMask(n, hn::Le(lower, eight(upper_))), boxes_that_exist(node, lane));
            const auto leaves = hn::And(near, hn::Lt(children, hn::Zero(n))); // TreeNode::kLeaf is the sign
            const auto is_new =
                hn::And(hn::Ne(children, hn::Set(n, static_cast<std::int32_t>(first_leaf_))),
                        hn::Ne(children, hn::Set(n, static_cast<std::int32_t>(second_leaf_))));
            leaves_.add(hn::And(leaves, is_new), lower, children);
            const auto nodes = hn::AndNot(leaves, near);
            if (!hn::AllFalse(n, nodes)) [[unlikely]]
                push_nodes(nodes, children);
        }
    }

    /// Descends to a leaf, always into the nearest box.
    HWY_NOINLINE void visit_leaf_by_descent() {
        std::uint32_t child = 0;
        do {
            const TreeNode& node = map_.nodes[child];
            alignas(32) std::array<float, kWidth> distances;
            for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(Eight())) {
                const auto exists = hn::RebindMask(Eight(), boxes_that_exist(node, lane));
                hn::Store(hn::IfThenElse(exists, measure_.boxes(node, lane), eight(kInfinity)), Eight(),
                          &distances[lane]);
            }
            const auto nearest = std::min_element(distances.begin(), distances.end());
            child = node.children[static_cast<std::size_t>(nearest - distances.begin())];
        } while ((child & TreeNode::kLeaf) == 0);
        if (child == first_leaf_) return;
        second_leaf_ = child;
        visit_leaf(child - TreeNode::kLeaf);
    }

    /// Visits the leaves, as many at a time as there are lanes, nearest first.
    HWY_INLINE void visit_leaves() {
        constexpr Eight f;
        for (std::size_t first = 0; first < leaves_.size; first += hn::Lanes(f)) {
            EightLanes distances = hn::IfThenElse(hn::FirstN(f, leaves_.size - first),
                                                  hn::LoadU(f, &leaves_.distances[first]), eight(kInfinity));
            for (;;) {
                const EightLanes least = hn::MinOfLanes(f, distances);
                const float distance = hn::GetLane(least);
                if (!(distance <= upper_) || distance == kInfinity) break;
                const auto lane = std::countr_zero(bits_of(hn::Eq(distances, least)));
                visit_leaf(leaves_.children[first + static_cast<std::size_t>(lane)] - TreeNode::kLeaf);
                const auto is_visited = hn::Eq(hn::Iota(f, 0), eight(static_cast<float>(lane)));
                distances = hn::IfThenElse(is_visited, eight(kInfinity), distances);
            }
        }
        leaves_.size = 0;
    }

    template <typename Mask>
    static HWY_INLINE std::uint32_t bits_of(Mask mask) {
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(Eight(), mask, bits.data());
        return bits[0];
    }

    /// The k-th corners of neighbouring faces.
    HWY_INLINE EightPlaces corner_lanes(std::size_t k, std::size_t first) const {
        const IndexArray& corners = map_.corners;
        return corners.wide.empty() ? vertex_lanes(&corners.narrow[3 * first + k])
                                    : vertex_lanes(&corners.wide[3 * first + k]);
    }
    /// @param corners  the vertex numbers; every third one is used
    template <typename Vertex>
    HWY_INLINE EightPlaces vertex_lanes(const Vertex* corners) const {
        const std::int32_t* vertices = &map_.vertices.data()->x;
        // Loads the vertex as the last three numbers of a row.
        constexpr hn::RebindToSigned<Eight> i;
        const auto [before, x, y, z] =
            load_rows(i, [=](std::size_t lane) HWY_ATTR {
                const std::size_t vertex = corners[3 * lane];
                return hn::LoadU(hn::FixedTag<std::int32_t, 4>(), vertices + 3 * vertex - 1);
            }).at;
        return {x, y, z};
    }

    /// If the last leaf is not full, faces of the leaf before it fill it up.
    HWY_INLINE void visit_leaf(std::uint32_t leaf) {
        const std::size_t first = std::min(std::size_t{leaf} * kWidth, map_.face_count() - kWidth);
        if (size_ == kCapacity) settle();
        std::array<float, kWidth>& lowers = lowers_[size_];
        EightLanes least_upper = eight(upper_), least_lower = eight(Measure::kFarthest);
        for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(Eight())) {
            const FaceBounds bounds = measure_.faces(
                corner_lanes(0, first + lane), corner_lanes(1, first + lane), corner_lanes(2, first + lane));
            hn::Store(bounds.lower, Eight(), &lowers[lane]);
            least_upper = hn::Min(least_upper, bounds.upper);
            least_lower = hn::Min(least_lower, bounds.lower);
        }
        upper_ = hn::GetLane(hn::MinOfLanes(Eight(), least_upper));
        firsts_[size_] = static_cast<std::uint32_t>(first);
        if (!hn::AllFalse(Eight(), hn::Le(least_lower, eight(upper_)))) ++size_;
    }

    /// Calls visit(face) for the faces that may be the nearest.
    template <typename Visit>
    HWY_INLINE void visit_candidates(const Visit& visit) const {
        for (std::size_t i = 0; i < size_; ++i) {
            std::uint32_t near = 0;
            for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(Eight()))
                near |= bits_of(hn::Le(hn::Load(Eight(), &lowers_[i][lane]), eight(upper_))) << lane;
            for (; near != 0; near &= near - 1)
                visit(firsts_[i] + static_cast<std::uint32_t>(std::countr_zero(near)));
        }
    }

    void measure_exactly(std::uint32_t face) {
        const double distance_sq = measure_.distance_sq(map_, face);
        if (!(distance_sq <= nearest_sq_) ||
            (nearest_ != kNoFace && distance_sq == nearest_sq_ && face > nearest_))
            return;
        nearest_sq_ = distance_sq;
        nearest_ = face;
    }

    /// Reduces the candidates to the nearest one.
    HWY_NOINLINE void settle() {
        visit_candidates([&](std::uint32_t face) { measure_exactly(face); });
        size_ = 0;
        if (nearest_ != kNoFace) upper_ = std::min(upper_, measure_.limit_by(nearest_sq_));
    }

    std::uint32_t choose() {
        if (nearest_ == kNoFace && std::isinf(nearest_sq_)) {
            // There must be a nearest face, so a single candidate need not be measured.
            std::uint32_t count = 0, last = kNoFace;
            visit_candidates([&](std::uint32_t face) {
                last = face;
                ++count;
            });
            if (count == 1) return last;
        }
        visit_candidates([&](std::uint32_t face) { measure_exactly(face); });
        return nearest_;
    }

    const ExactMapView& map_;
    Measure measure_;

    float upper_ = 0;                 ///< no nearest face is farther, in the unit of the measure
    std::uint32_t nearest_ = kNoFace; ///< the nearest of the faces measured exactly
    double nearest_sq_ = 0;

    // Leaves with candidates, by their first faces, and lower bounds for their faces.
    static constexpr std::size_t kCapacity = 32;
    std::size_t size_ = 0;
    std::array<std::uint32_t, kCapacity> firsts_;
    alignas(32) std::array<std::array<float, kWidth>, kCapacity> lowers_;

    // The nodes still to be visited, at most as many as in walk_near_leaves().
    static constexpr std::size_t kMaxDepth = 12;
    std::size_t node_count_ = 0;
    std::array<std::uint32_t, kMaxDepth * kWidth + kWidth> nodes_;
    Leaves leaves_;
    std::uint32_t first_leaf_ = kNoLeaf, second_leaf_ = kNoLeaf; ///< visited before; numbered as children
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
