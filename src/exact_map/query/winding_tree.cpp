#include "exact_map/query/winding_tree.hpp"

#include "directions/face_cone.hpp"
#include "exact_map/layout.hpp"
#include "geometry/elementary.hpp"

#include <echinus/exact_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "exact_map/query/winding_tree.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h, which includes this file once per instruction set.
#include "simd/dispatch.hpp"

#include <hwy/highway.h>

#ifndef ECHINUS_WINDING_SUM
#define ECHINUS_WINDING_SUM
namespace echinus {
namespace {

/// A winding number, and whether its error is small enough for the goal.
struct WindingSum {
    double value;
    bool decided;
};

/// The distance of a winding number from the nearest value at which the answer changes or its certainty does,
/// kCertainMargin away from the former.
double distance_from_turning_point(double winding, WindingGoal::Turn turn) {
    const double from_turn = distance_from_turn(winding, turn);
    return std::min(from_turn, std::fabs(from_turn - kCertainMargin));
}

} // namespace
} // namespace echinus
#endif

HWY_BEFORE_NAMESPACE();
namespace echinus::HWY_NAMESPACE {

namespace {

constexpr std::size_t kWidth = TreeNode::kWidth;
using Row = std::array<double, kWidth>;

/// An angle represented as a complex number, so that angles are added by a product.
struct Angle {
    double re = 1, im = 0;
    double turns = 0; ///< full turns to be added

    /// Adds the argument of a complex number that is not a negative real number.
    void add(double other_re, double other_im) {
        const double product_re = re * other_re - im * other_im;
        const double product_im = re * other_im + im * other_re;
        if (im >= 0 && other_im >= 0 && product_im < 0) turns += 1;
        if (im < 0 && other_im < 0 && product_im >= 0) turns -= 1;
        re = product_re;
        im = product_im;
    }

    /// Keeps the numbers in the range of double.
    void normalise() {
        const double scale = 1 / (std::fabs(re) + std::fabs(im));
        re *= scale;
        im *= scale;
    }

    double in_turns() const {
        const double upper_im = im + 0.0; // -0 becomes 0, since add() counts it as not negative
        return turns + portable_atan2(upper_im, re) / (2 * std::numbers::pi);
    }
};

/// Sums the winding number of one place: first groups of faces seen from afar, then, in place of the groups
/// with the largest error bounds, the parts of these, until the error is small enough.
class TreeSum {
  public:
    /// @param kept_error  groups with a smaller error are not divided
    TreeSum(const ExactMapView& map, const Vec3d& place, const LatticePoint* on_lattice, int crossings,
            double kept_error)
        : map_(map), tree_(*map.winding_tree), place_(place), on_lattice_(on_lattice), crossings_(crossings),
          sign_(tree_.has_caps ? -1 : 1), rounding_(rounding_at(place, on_lattice != nullptr)),
          kept_error_(kept_error) {}

    WindingSum operator()(const WindingGoal& goal) {
        constexpr double kWorthALook = 0.5 - kCertainMargin; // far from all turns if they are one apart
        double needed = std::min(goal.tolerance, kWorthALook);
        add(0);
        while (true) {
            if (error() < needed) {
                const double sum = value();
                needed = std::min(goal.tolerance, distance_from_turning_point(sum, goal.turn));
                if (error() < needed) return {sum, true};
            }
            if (!part_the_worst()) return {value(), false};
        }
    }

  private:
    /// Caps close the surface: their contribution to the whole, which the crossings count, must be
    /// subtracted.
    double value() const { return crossings_ + sign_ * (far_value_ + angle_.in_turns()); }
    /// Includes an allowance for the rounding of all sums.
    double error() const {
        constexpr double kRounding = 0x1p-36;
        return far_error_ + angle_error_ + magnitude_ * kRounding + 0x1p-40;
    }

    /// Faces seen from afar. Small, so that all groups together fit on a small stack.
    struct Group {
        double value;
        float error;         ///< rounded up
        std::uint32_t child; ///< as in TreeNode
    };
    static_assert(sizeof(Group) == 16);

    static float rounded_up(double error) { return static_cast<float>(error * (1 + 0x1p-23)); }

    /// Groups by error: those with an error of up to 2^-n are in bin n.
    class Bins {
      public:
        /// Returns false if the bin is full.
        bool add(const Group& group) {
            const int halvings = -std::ilogb(group.error) - 1;
            const auto bin = static_cast<std::size_t>(std::clamp(halvings, 0, static_cast<int>(kCount) - 1));
            if (sizes_[bin] == kCapacity) return false;
            groups_[bin][sizes_[bin]++] = group;
            worst_ = std::min(worst_, bin);
            return true;
        }
        std::optional<Group> take_worst() {
            while (worst_ < kCount && sizes_[worst_] == 0) ++worst_;
            if (worst_ == kCount) return std::nullopt;
            return groups_[worst_][--sizes_[worst_]];
        }

      private:
        static constexpr std::size_t kCount = 40, kCapacity = 24;

        std::array<std::uint8_t, kCount> sizes_{};
        std::size_t worst_ = kCount;
        std::array<std::array<Group, kCapacity>, kCount> groups_;
    };

    /// Divides the group with the largest error. Returns false if no group may be divided.
    bool part_the_worst() {
        const std::optional<Group> worst = bins_.take_worst();
        if (!worst) return false;
        far_value_ -= worst->value;
        far_error_ -= static_cast<double>(worst->error);
        add(worst->child);
        return true;
    }

    /// Adds a child of a node. Its own children are seen from afar or, if they are too near for that, added
    /// in the same way.
    void add(std::uint32_t child) {
        constexpr std::size_t kMaxDepth = 12; // as in walk_near_leaves()
        std::array<std::uint32_t, kMaxDepth * kWidth> waiting;
        std::size_t count = 0;
        waiting[count++] = child;
        while (count > 0) {
            const std::uint32_t next = waiting[--count];
            if ((next & TreeNode::kLeaf) != 0) {
                add_leaf((next - TreeNode::kLeaf) * static_cast<std::uint32_t>(kWidth));
                continue;
            }
            const FarChildren children = seen_from(place_, tree_.moments[next]);
            for (std::size_t k = 0; k < kWidth; ++k) {
                const std::uint32_t part = tree_.nodes[next].children[k];
                if (!(children.errors[k] < kTooFarOff) ||
                    !keep({children.values[k], rounded_up(children.errors[k]), part}))
                    waiting[count++] = part;
                else
                    magnitude_ += children.areas[k] + children.errors[k];
            }
        }
    }

    /// Adds a group, unless its error is so large that it must be remembered for division and there is no
    /// room left.
    bool keep(const Group& group) {
        const auto error = static_cast<double>(group.error);
        if (error > kept_error_ && !bins_.add(group)) return false;
        far_value_ += group.value;
        far_error_ += error;
        return true;
    }

    /// The children of a node, seen from a place.
    struct FarChildren {
        Row values, areas;
        Row errors; ///< infinite if a child is too near
    };

    /// Loops over separate arrays, so that the compiler can vectorise.
    static FarChildren seen_from(const Vec3d& place, const WindingNode& node) {
        constexpr double kTooNear = 0.9; // ratio of radius to distance
        FarChildren result;
        for (std::size_t k = 0; k < kWidth; ++k) {
            const double x = node.centre[0][k] - place.x, y = node.centre[1][k] - place.y,
                         z = node.centre[2][k] - place.z;
            const double xx = x * x, yy = y * y, zz = z * z;
            const double inverse_sq = 1 / (xx + yy + zz), inverse = std::sqrt(inverse_sq);
            const double along = node.area[0][k] * x + node.area[1][k] * y + node.area[2][k] * z;
            const double quadratic = node.first[0][k] * xx + node.first[1][k] * yy + node.first[2][k] * zz +
                                     node.first[3][k] * (x * y) + node.first[4][k] * (x * z) +
                                     node.first[5][k] * (y * z);
            const double cubic = x * (node.second[0][k] * (xx - 3 * zz) + node.second[3][k] * (yy - zz)) +
                                 y * (node.second[1][k] * (yy - 3 * zz) + node.second[4][k] * (xx - zz)) +
                                 z * (node.second[2][k] * (zz - 3 * xx) + node.second[5][k] * (yy - xx)) +
                                 node.second[6][k] * (x * y * z);
            const double value =
                inverse_sq * inverse * (along + inverse_sq * (quadratic + inverse_sq * cubic));
            const double t = node.radius[k] * inverse, rest = 1 - t;
            const double error = node.spread[k] * inverse_sq * inverse_sq * (t * (4 - 3 * t) / (rest * rest));
            result.values[k] = value;
            result.errors[k] = t < kTooNear ? error : std::numeric_limits<double>::infinity();
            result.areas[k] = node.total_area[k] * inverse_sq;
        }
        return result;
    }

    struct Corner {
        Row x, y, z;
    };

    /// The faces of a leaf as complex numbers whose arguments are half their solid angles: van Oosterom and
    /// Strackee 1983. They are divided by the product of the distances, so that their absolute values are at
    /// most 4. For a lattice point they are off by less than 2^-46: coordinates are then integers, and only
    /// products and roots are rounded.
    struct Leaf {
        Row re, im;
        Row doubts; ///< bounds of the arguments' errors
    };

    Leaf angles_of(std::uint32_t first, std::uint32_t count, const Vec3d& nudge) const {
        std::array<Corner, 3> corners;
        for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
            const std::size_t face = first + std::min(lane, count - 1);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3<std::int32_t>& v = map_.vertices[tree_.corners[3 * face + k]];
                corners[k].x[lane] = v.x - place_.x - nudge.x;
                corners[k].y[lane] = v.y - place_.y - nudge.y;
                corners[k].z[lane] = v.z - place_.z - nudge.z;
            }
        }
        Leaf leaf;
        const double rounding = rounding_;
        for (std::size_t k = 0; k < kWidth; ++k) {
            const double ax = corners[0].x[k], ay = corners[0].y[k], az = corners[0].z[k];
            const double bx = corners[1].x[k], by = corners[1].y[k], bz = corners[1].z[k];
            const double cx = corners[2].x[k], cy = corners[2].y[k], cz = corners[2].z[k];
            const double la = std::sqrt(ax * ax + ay * ay + az * az);
            const double lb = std::sqrt(bx * bx + by * by + bz * bz);
            const double lc = std::sqrt(cx * cx + cy * cy + cz * cz);
            const double volume =
                ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
            const double ab = ax * bx + ay * by + az * bz, bc = bx * cx + by * cy + bz * cz,
                         ca = cx * ax + cy * ay + cz * az;
            const double inverse = 1 / (la * lb * lc);
            leaf.re[k] = 1 + (ab * lc + bc * la + ca * lb) * inverse;
            leaf.im[k] = volume * inverse;
            leaf.doubts[k] = rounding / std::sqrt(leaf.re[k] * leaf.re[k] + leaf.im[k] * leaf.im[k]);
        }
        return leaf;
    }

    void add_leaf(std::uint32_t first) {
        const std::uint32_t count = std::min(static_cast<std::uint32_t>(kWidth),
                                             static_cast<std::uint32_t>(tree_.triangle_count()) - first);
        const Leaf leaf = angles_of(first, count, {});
        if (is_certain(leaf)) [[likely]]
            add_angles(leaf, first, count);
        else
            add_leaf_from_beside(first, count);
    }

    /// A place on an edge counts as displaced by (e, e^2, e^3). Here e is tiny: less than the distance of
    /// lattice points from edges, and more than rounding.
    void add_leaf_from_beside(std::uint32_t first, std::uint32_t count) {
        constexpr double kHair = 0x1p-22;
        const Leaf leaf = angles_of(first, count, {kHair, kHair * 0x1p-9, 0});
        if (is_certain(leaf))
            add_angles(leaf, first, count);
        else
            angle_error_ += 1; // nothing is known about the sum
    }

    /// The rounding error of a leaf's complex numbers. Relative to a place that is no lattice point,
    /// coordinates are rounded in proportion to its own, which matters if it is near the surface. Such a
    /// place lies beyond the lattice, hence beyond the sphere that contains the surface.
    static double rounding_at(const Vec3d& place, bool on_lattice) {
        constexpr double kOnLattice = 0x1p-46;
        if (on_lattice) return kOnLattice;
        const double distance = length(place);
        const double clearance = distance - static_cast<double>(kLatticeExtent + 2);
        return kOnLattice * (1 + distance / std::max(clearance, 0.25));
    }

    /// Are the arguments of all numbers known? They are not if the place is on an edge.
    static bool is_certain(const Leaf& leaf) {
        constexpr double kMostDoubt = 1.0 / 64;
        bool certain = true;
        for (std::size_t k = 0; k < kWidth; ++k) certain &= leaf.doubts[k] < kMostDoubt;
        return certain;
    }

    void add_angles(const Leaf& leaf, std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = 0; k < count; ++k) {
            angle_error_ += leaf.doubts[k];
            if (leaf.re[k] < 0 && std::fabs(leaf.im[k]) <= rounding_) [[unlikely]]
                angle_.turns += half_turn(first + k); // on the face, which covers half of all directions
            else
                angle_.add(leaf.re[k], leaf.im[k]);
        }
        angle_.normalise();
    }

    /// The half turn of a face on which the place lies: positive if the place counts as behind the face, on
    /// the side of its solid. This is decided exactly and, in the face's plane, by the perturbation. A face
    /// without area has no solid angle.
    double half_turn(std::uint32_t face) const {
        const auto corner = [&](std::size_t k) {
            return LatticePoint(map_.vertices[tree_.corners[3 * std::size_t{face} + k]]);
        };
        const LatticePoint a = corner(0), normal = cross(corner(1) - a, corner(2) - a);
        if (normal == LatticePoint{}) return 0;
        const LatticePoint p = on_lattice_ != nullptr ? *on_lattice_ : rounded(place_);
        const std::int64_t height = dot(normal, a - p);
        const bool is_behind = height != 0 ? height > 0 : sign_of_perturbation(normal) < 0;
        return is_behind ? 0.5 : -0.5;
    }

    const ExactMapView& map_;
    const WindingTree& tree_;
    Vec3d place_;
    const LatticePoint* on_lattice_;
    double crossings_;
    double sign_; ///< the sign of the sum in the winding number

    static constexpr double kTooFarOff = 0.5; // a larger error is not worth remembering

    double rounding_;
    double kept_error_;
    double far_value_ = 0, far_error_ = 0;
    double magnitude_ = 0; ///< an upper bound of the sum of all terms' absolute values
    Bins bins_;
    Angle angle_; ///< the sum of the solid angles of the faces nearby
    double angle_error_ = 0;
};

} // namespace

WindingSum sum_by_tree(const ExactMapView& map, const Vec3d& place, const LatticePoint* on_lattice,
                       int crossings, double kept_error, const WindingGoal& goal) {
    return TreeSum(map, place, on_lattice, crossings, kept_error)(goal);
}

} // namespace echinus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace echinus {

namespace {

HWY_EXPORT(sum_by_tree);

} // namespace

std::optional<double> decided_winding_by_tree(const ExactMapView& map, const Vec3d& place,
                                              const LatticePoint* on_lattice, int crossings,
                                              const WindingGoal& goal) noexcept {
    constexpr double kFinest = 1e-8; // the accuracy that rounding in double permits
    constexpr double kLeastKept = 0x1p-36;
    const WindingGoal wanted{goal.turn, std::max(goal.tolerance, kFinest)};
    for (double kept = std::min(0x1p-8, wanted.tolerance * 0x1p-5);;
         kept = kept > kLeastKept ? kept * 0x1p-6 : 0) {
        const WindingSum sum = ECHINUS_DISPATCH(sum_by_tree)(map, place, on_lattice, crossings, kept, wanted);
        if (sum.decided) return sum.value;
        if (kept == 0) return std::nullopt;
    }
}

} // namespace echinus
#endif
