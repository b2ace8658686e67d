// Included once per instruction set, as Highway requires; hence the unusual include guard.
#if defined(ECHINUS_FACE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ECHINUS_FACE_LANES_INL
#undef ECHINUS_FACE_LANES_INL
#else
#define ECHINUS_FACE_LANES_INL
#endif

#include "exact_map/layout.hpp"
#include "exact_map/query/nearest.hpp"
#include "simd/lanes-inl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#if HWY_TARGET != HWY_SCALAR // HWY_SCALAR uses the reference instead
HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

/// Bounds of the squared distances from places to a face.
struct DistanceLanes {
    FloatLanes lower, upper;
};

/// The faces of a leaf, prepared for distances in single precision. When they are prepared, the lanes are
/// faces; when distances to their three edges and, above the face, to its plane are measured, the lanes are
/// places.
///
/// Rounding. Let S be the sum of the absolute coordinates of corners and places. Corners and places are off
/// by less than 2^-22 S, hence the distance to an edge by less than 2^-19 S. The distance to the plane and
/// the positions of its sides are off by that times q = |u| |v| / |u x v| for the sharpest corner, between
/// sides u and v. The bounds allow for twice that, e = 2^-18 S q: squared distances lie within d^2 (1 -
/// 2^-12) - 2^13 e^2 and the like, since 2 d e is at most 2^-13 d^2 + 2^13 e^2. If q is large, only the edges
/// are measured: no point of the face is farther from them than its width w, and (d - w)^2 is at least d^2 /
/// 2 - w^2.
class LeafLanes {
  public:
    /// @param reach  an upper bound of the L1 norms of all places
    void prepare(const ExactMapView& map, std::uint32_t first_face, std::uint32_t count,
                 const Vec3<std::int32_t>& origin, const Vec3f& stretch, float reach) {
        for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
            const std::size_t face = first_face + (lane < count ? lane : 0);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3<std::int32_t> corner = map.vertices[map.corners[3 * face + k]] - origin;
                corners_[k].x[lane] = static_cast<float>(corner.x) * stretch.x;
                corners_[k].y[lane] = static_cast<float>(corner.y) * stretch.y;
                corners_[k].z[lane] = static_cast<float>(corner.z) * stretch.z;
            }
        }
        constexpr Faces d;
        for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(d)) prepare_lanes(lane, reach);
    }

    DistanceLanes distances_sq(std::size_t face, const PointLanes& place) const {
        constexpr Floats f;
        const auto all = [&](const Row& row) HWY_ATTR { return hn::Set(f, row[face]); };
        const auto all_of = [&](const Rows& rows) HWY_ATTR {
            return PointLanes{all(rows.x), all(rows.y), all(rows.z)};
        };
        const FloatLanes zero = hn::Zero(f), one = hn::Set(f, 1);
        const std::array<PointLanes, 3> starts{all_of(corners_[0]) - place, all_of(corners_[1]) - place,
                                               all_of(corners_[2]) - place};
        FloatMask above = hn::Eq(zero, zero);
        for (std::size_t k = 0; k < 3; ++k)
            above = hn::And(above, hn::Gt(fused_dot(starts[k], all_of(inward_[k])), zero));
        const FloatLanes height = fused_dot(starts[0], all_of(normals_));
        FloatLanes distance_sq = hn::Mul(hn::Mul(height, height), all(normal_inverses_));
        if (!hn::AllTrue(f, above)) {
            FloatLanes to_edges = hn::Set(f, kFar);
            for (std::size_t k = 0; k < 3; ++k) {
                const PointLanes& start = starts[k];
                const PointLanes edge = all_of(edges_[k]);
                const FloatLanes share =
                    hn::Min(hn::Max(hn::Mul(fused_dot(start, edge), all(minus_inverses_[k])), zero), one);
                const PointLanes nearest{hn::MulAdd(edge.x, share, start.x),
                                         hn::MulAdd(edge.y, share, start.y),
                                         hn::MulAdd(edge.z, share, start.z)};
                to_edges = hn::Min(to_edges, fused_dot(nearest, nearest));
            }
            distance_sq = hn::IfThenElse(above, distance_sq, to_edges);
        }
        return {hn::MulSub(distance_sq, all(lower_factors_), all(lower_terms_)),
                hn::MulAdd(distance_sq, hn::Set(f, kUpperFactor), all(upper_terms_))};
    }

    /// Lower bounds of the squared distances between the box around some places and the boxes around the
    /// faces, all stretched.
    void distances_sq_to_box(const Vec3f& low, const Vec3f& high,
                             std::array<float, TreeNode::kWidth>& distances_sq) const {
        constexpr Faces d;
        for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(d)) {
            FaceLanes sum = hn::Zero(d);
            const auto add_axis = [&](const Row& a, const Row& b, const Row& c, float low_bound,
                                      float high_bound) {
                const FaceLanes u = hn::Load(d, &a[lane]), v = hn::Load(d, &b[lane]),
                                w = hn::Load(d, &c[lane]);
                const FaceLanes above_all = hn::Sub(hn::Min(hn::Min(u, v), w), hn::Set(d, high_bound));
                const FaceLanes below_all = hn::Sub(hn::Set(d, low_bound), hn::Max(hn::Max(u, v), w));
                const FaceLanes gap = hn::Max(hn::Max(above_all, below_all), hn::Zero(d));
                sum = hn::MulAdd(gap, gap, sum);
            };
            add_axis(corners_[0].x, corners_[1].x, corners_[2].x, low.x, high.x);
            add_axis(corners_[0].y, corners_[1].y, corners_[2].y, low.y, high.y);
            add_axis(corners_[0].z, corners_[1].z, corners_[2].z, low.z, high.z);
            const FaceLanes terms = hn::Load(d, &upper_terms_[lane]);
            hn::StoreU(hn::Sub(hn::Mul(sum, hn::Set(d, kLowerFactor)), terms), d, &distances_sq[lane]);
        }
    }

  private:
    static constexpr std::size_t kWidth = TreeNode::kWidth;
    static constexpr float kFar = 1e30F;
    static constexpr float kLowerFactor = 1 - 0x1p-12F, kUpperFactor = 1 + 0x1p-12F;

    using Faces = hn::CappedTag<float, kWidth>;
    using FaceLanes = hn::Vec<Faces>;
    using FaceVectors = Vec3Lanes<FaceLanes>;
    using Row = std::array<float, kWidth>;
    struct Rows {
        alignas(32) Row x, y, z;
    };

    /// The reciprocal; 0 for 0.
    static FaceLanes inverse(FaceLanes value) {
        constexpr Faces d;
        return hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), hn::Div(hn::Set(d, 1), value));
    }

    void prepare_lanes(std::size_t first, float reach) {
        constexpr Faces d;
        const auto load = [&](const Rows& rows) {
            return FaceVectors{hn::Load(d, &rows.x[first]), hn::Load(d, &rows.y[first]),
                               hn::Load(d, &rows.z[first])};
        };
        const auto store = [&](const FaceVectors& v, Rows& rows) {
            hn::Store(v.x, d, &rows.x[first]);
            hn::Store(v.y, d, &rows.y[first]);
            hn::Store(v.z, d, &rows.z[first]);
        };
        const FaceVectors a = load(corners_[0]), b = load(corners_[1]), c = load(corners_[2]);
        const FaceVectors ab = b - a, bc = c - b, ca = a - c;
        const FaceVectors normal = cross(ab, bc);
        const FaceLanes ab_sq = fused_dot(ab, ab), bc_sq = fused_dot(bc, bc), ca_sq = fused_dot(ca, ca),
                        normal_sq = fused_dot(normal, normal);

        const FaceLanes scale =
            hn::Add(hn::Add(l1_norm(a), l1_norm(b)), hn::Add(l1_norm(c), hn::Set(d, reach)));
        const FaceLanes error_sq = hn::Mul(hn::Mul(scale, scale), hn::Set(d, 0x1p-23F));
        constexpr float kThin = 1024; // limit of q^2 beyond which the plane is not used
        const FaceLanes sides_sq =    // squared product of the two longest; they meet at the sharpest corner
            hn::Max(hn::Max(hn::Mul(ab_sq, bc_sq), hn::Mul(bc_sq, ca_sq)), hn::Mul(ca_sq, ab_sq));
        const auto has_plane = hn::Lt(sides_sq, hn::Mul(normal_sq, hn::Set(d, kThin)));
        const FaceLanes q_sq = hn::Mul(sides_sq, inverse(normal_sq));
        const FaceLanes with_plane = hn::Mul(error_sq, hn::Max(q_sq, hn::Set(d, 1)));
        const FaceLanes width_sq = hn::Mul(normal_sq, inverse(hn::Max(hn::Max(ab_sq, bc_sq), ca_sq)));
        const FaceLanes upper_term = hn::IfThenElse(has_plane, with_plane, error_sq);
        hn::Store(upper_term, d, &upper_terms_[first]);
        hn::Store(hn::IfThenElse(has_plane, with_plane, hn::MulAdd(width_sq, hn::Set(d, 1.01F), error_sq)), d,
                  &lower_terms_[first]);
        hn::Store(hn::IfThenElse(has_plane, hn::Set(d, kLowerFactor), hn::Set(d, kLowerFactor / 2)), d,
                  &lower_factors_[first]);

        store(ab, edges_[0]);
        store(bc, edges_[1]);
        store(ca, edges_[2]);
        hn::Store(hn::Neg(inverse(ab_sq)), d, &minus_inverses_[0][first]);
        hn::Store(hn::Neg(inverse(bc_sq)), d, &minus_inverses_[1][first]);
        hn::Store(hn::Neg(inverse(ca_sq)), d, &minus_inverses_[2][first]);
        // If there is no plane, no place counts as above the face.
        const auto if_plane = [&](const FaceVectors& v) {
            return FaceVectors{hn::IfThenElseZero(has_plane, v.x), hn::IfThenElseZero(has_plane, v.y),
                               hn::IfThenElseZero(has_plane, v.z)};
        };
        store(if_plane(cross(ab, normal)), inward_[0]);
        store(if_plane(cross(bc, normal)), inward_[1]);
        store(if_plane(cross(ca, normal)), inward_[2]);
        store(if_plane(normal), normals_);
        hn::Store(hn::IfThenElseZero(has_plane, inverse(normal_sq)), d, &normal_inverses_[first]);
    }

    std::array<Rows, 3> corners_, edges_, inward_;
    Rows normals_;
    alignas(32) std::array<Row, 3> minus_inverses_;
    alignas(32) Row normal_inverses_, lower_factors_, lower_terms_, upper_terms_;
};

/// The faces that may be the nearest for some of the current places.
class FaceCandidates {
  public:
    void clear() { size_ = 0; }
    std::size_t size() const { return size_; }
    bool full() const { return size_ == kCapacity; }

    void add(std::uint32_t face, FloatLanes lower) {
        faces_[size_] = face;
        hn::Store(lower, Floats(), lowers_[size_].data());
        ++size_;
    }

    /// Drops the candidates that are too far for every place.
    void keep_within(FloatLanes upper) {
        constexpr Floats f;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            const FloatLanes lower = hn::Load(f, lowers_[i].data());
            if (hn::AllFalse(f, hn::Le(lower, upper))) continue;
            faces_[kept] = faces_[i];
            hn::Store(lower, f, lowers_[kept].data());
            ++kept;
        }
        size_ = kept;
    }

    /// Sets, for each place, the candidate that the scalar query would return.
    /// @param upper  upper bounds of the distances between places and their nearest faces, in the unit of the
    ///               lower bounds
    void choose(const ExactMapView& map, const Vec3d& stretch, std::span<const NearestSearch> searches,
                FloatLanes upper, std::span<std::uint32_t> faces) const {
        std::array<double, kMaxLanes> distances_sq;
        std::uint32_t measured = 0; // places whose face's distance is known
        std::fill(faces.begin(), faces.end(), kNoFace);
        const std::uint32_t asked = (1U << searches.size()) - 1;
        for (std::size_t i = 0; i < size_; ++i) {
            const std::uint32_t face = faces_[i];
            for (std::uint32_t rest = places_within(i, upper) & asked; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                const NearestSearch& search = searches[lane];
                const bool bounded = std::isfinite(search.farthest);
                if (faces[lane] == kNoFace && !bounded) { // there must be a nearest face, and this may be it
                    faces[lane] = face;
                    continue;
                }
                const auto distance_to = [&](std::uint32_t other) {
                    return distance_sq_to_face(map, other, search.place, stretch);
                };
                if (faces[lane] != kNoFace && (measured >> lane & 1) == 0)
                    distances_sq[lane] = distance_to(faces[lane]);
                measured |= 1U << lane;
                const double distance_sq = distance_to(face);
                const bool nearer = faces[lane] == kNoFace
                                        ? distance_sq <= search.farthest * search.farthest
                                        : distance_sq < distances_sq[lane] ||
                                              (distance_sq == distances_sq[lane] && face < faces[lane]);
                if (!nearer) continue;
                faces[lane] = face;
                distances_sq[lane] = distance_sq;
            }
        }
    }

  private:
    /// A bit for each place for which the face may be the nearest.
    std::uint32_t places_within(std::size_t i, FloatLanes upper) const {
        constexpr Floats f;
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(f, hn::Le(hn::Load(f, lowers_[i].data()), upper), bits.data());
        return bits[0] | std::uint32_t{bits[1]} << 8;
    }

    static constexpr std::size_t kCapacity = 64;
    static constexpr std::size_t kMaxLanes = 16;

    std::size_t size_ = 0;
    std::array<std::uint32_t, kCapacity> faces_;
    alignas(64) std::array<std::array<float, kMaxLanes>, kCapacity> lowers_;
};

/// nearest_face() for as many distant places as there are lanes, in one walk through the tree. It compares in
/// single precision the excess that nearest.cpp explains.
///
/// On a triangle the excess is least at a corner, except for its square term, which lowers it by at most s^2
/// / 2 d if the edges are no longer than s.
class FacesFromAfar {
  public:
    explicit FacesFromAfar(const ExactMapView& map) : map_(map) {}

    /// Can these lanes answer this search? A bounded one needs the scalar query's comparison.
    static bool is_for(const NearestSearch& search) {
        return is_afar(search.place) && !std::isfinite(search.farthest);
    }

    /// @param searches  at least one, and no more than there are lanes; is_for() holds
    /// @returns  false, and no faces, if too many faces are about equally near to be told apart here
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
    static constexpr float kSlack = 1; ///< lattice steps; more than the rounding errors
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
        float distance; ///< the lowest excess of all places; the key for sorting
        std::uint32_t node, child;
    };

    /// Returns false if there were too many candidates.
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
            if (node.low[0][child] > node.high[0][child]) continue; // there is no such child
            const FloatLanes excess = box_excess(node, child);
            if (!is_near(excess)) continue;
            const float least = hn::GetLane(hn::MinOfLanes(Floats(), excess));
            push_sorted(waiting_.data(), before, count, Waiting{least, number, child});
        }
        return count;
    }

    /// Lower bounds of the excess in a box.
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
    FloatLanes upper_;      ///< each place's nearest face certainly has no larger excess

    FaceCandidates candidates_;
    static constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
    std::array<Waiting, kMaxDepth * TreeNode::kWidth> waiting_;
};

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif
