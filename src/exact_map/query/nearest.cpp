#include "exact_map/query/nearest.hpp"

#include "exact_map/layout.hpp"
#include "geometry/triangle.hpp"

#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr std::size_t kLanes = TreeNode::kWidth;
constexpr Vec3d kUnstretched{1, 1, 1};

Vec3d stretched(const Vec3d& v, const Vec3d& stretch) {
    return {v.x * stretch.x, v.y * stretch.y, v.z * stretch.z};
}

/// The corners of a face, stretched, relative to the place.
using Corners = TriangleCorners;

Corners corners_around(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                       const Vec3d& stretch) {
    const auto corners = face_corners(map, face);
    return {stretched(Vec3d(corners[0]) - place, stretch), stretched(Vec3d(corners[1]) - place, stretch),
            stretched(Vec3d(corners[2]) - place, stretch)};
}

/// The squared distance of a triangle from the origin, in a form that suits vector instructions: it always
/// measures the plane and all three edges, without a branch.
double distance_sq_to_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const Vec3d ab = b - a, bc = c - b, ca = a - c;
    const Vec3d on_ab = a + ab * nearest_share(a, ab);
    const Vec3d on_bc = b + bc * nearest_share(b, bc);
    const Vec3d on_ca = c + ca * nearest_share(c, ca);
    const double to_ab = dot(on_ab, on_ab), to_bc = dot(on_bc, on_bc), to_ca = dot(on_ca, on_ca);
    double least = to_ab < to_bc ? to_ab : to_bc;
    least = to_ca < least ? to_ca : least;
    const Vec3d normal = cross(ab, bc);
    const double above_ab = dot(cross(normal, a), ab);
    const double above_bc = dot(cross(normal, b), bc);
    const double above_ca = dot(cross(normal, c), ca);
    const double height = dot(a, normal);
    const double to_plane = height * height / dot(normal, normal);
    // For a face without area, all three are 0, so no point counts as above it.
    const bool above = (above_ab > 0) & (above_bc > 0) & (above_ca > 0);
    return above ? to_plane : least;
}

/// Squared distances to the faces of a leaf. Each coordinate has its own array, so that the compiler can
/// vectorise.
class LeafDistances {
  public:
    LeafDistances(const ExactMapView& map, const LeafFaces& faces, const Vec3d& place, const Vec3d& stretch) {
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t face = std::min(faces.first + lane, faces.last - 1);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3<std::int32_t>& v = map.vertices[map.corners[3 * face + k]];
                x_[k][lane] = v.x;
                y_[k][lane] = v.y;
                z_[k][lane] = v.z;
            }
        }
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const auto corner = [&](std::size_t k) {
                return Vec3d{(x_[k][lane] - place.x) * stretch.x, (y_[k][lane] - place.y) * stretch.y,
                             (z_[k][lane] - place.z) * stretch.z};
            };
            distances_sq_[lane] = distance_sq_to_triangle(corner(0), corner(1), corner(2));
        }
    }

    double distance_sq(std::size_t lane) const { return distances_sq_[lane]; }

  private:
    using Numbers = std::array<double, kLanes>;
    std::array<Numbers, 3> x_, y_, z_;
    Numbers distances_sq_;
};

/// Lower bounds of the squared distances from a place to the boxes of a node's children, in single precision:
/// the place is moved towards each box by more than the rounding errors.
class BoxDistances {
  public:
    BoxDistances(const Vec3d& place, const Vec3d& stretch) : place_(place), stretch_(stretch) {}

    ChildDistances operator()(const TreeNode& node) const {
        ChildDistances result;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const float x = outside(node.low[0][k], node.high[0][k], place_.x) * stretch_.x;
            const float y = outside(node.low[1][k], node.high[1][k], place_.y) * stretch_.y;
            const float z = outside(node.low[2][k], node.high[2][k], place_.z) * stretch_.z;
            const float sum = x * x + y * y + z * z;
            result[k] = node.low[0][k] > node.high[0][k] ? kNoChild : sum;
        }
        return result;
    }

  private:
    static constexpr float kUnit = ExactMapView::kBoxUnit;
    static constexpr float kSlack = 1;
    static constexpr float kNoChild = std::numeric_limits<float>::infinity();

    static float outside(std::int16_t low, std::int16_t high, float place) {
        const float below = low * kUnit - place;
        const float above = place - high * kUnit;
        const float larger = (below > above ? below : above) - kSlack;
        return larger > 0 ? larger : 0;
    }

    Vec3f place_, stretch_;
};

/// By how much a lattice point q is farther from a distant place than the centre is. With the place at
/// distance d in direction u,
///
///     (|place - q|^2 - d^2) / 2 d = q^2 / 2 d - u q,
///
/// which grows with the distance and loses little in single precision. The sum has one term per axis: a
/// parabola whose minimum is at the place's coordinate.
class BoxExcesses {
  public:
    explicit BoxExcesses(const Vec3d& place)
        : place_(place), direction_(place * (1 / length(place))),
          curvature_(static_cast<float>(0.5 / length(place))) {}

    ChildDistances operator()(const TreeNode& node) const {
        ChildDistances result;
        for (std::size_t k = 0; k < kLanes; ++k) {
            const float sum = least(node.low[0][k], node.high[0][k], place_.x, direction_.x) +
                              least(node.low[1][k], node.high[1][k], place_.y, direction_.y) +
                              least(node.low[2][k], node.high[2][k], place_.z, direction_.z);
            result[k] = node.low[0][k] > node.high[0][k] ? kNoChild : sum - kSlack;
        }
        return result;
    }

    static constexpr float kSlack = 1; ///< lattice steps; more than the rounding of terms below 2^20
    static constexpr float kNoChild = std::numeric_limits<float>::infinity();

  private:
    float least(std::int16_t low, std::int16_t high, float place, float direction) const {
        const float from = low * kUnit, to = high * kUnit;
        const float q = place < from ? from : place > to ? to : place;
        return q * (q * curvature_ - direction);
    }

    static constexpr float kUnit = ExactMapView::kBoxUnit;

    Vec3f place_, direction_;
    float curvature_;
};

/// A float above a double by more than the rounding errors of box distances. It is finite, since missing
/// children are at infinity.
float bound_above(double value) {
    return static_cast<float>(std::min(value, 1e37)) * (1 + 1e-6F);
}

/// The unit normal of the stretched face, pointing out of its front; 0 for a face without area.
Vec3d unit_normal(const ExactMapView& map, std::uint32_t face, const Vec3d& place, const Vec3d& stretch) {
    const Corners corners = corners_around(map, face, place, stretch);
    const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = length(normal);
    const double mirror = stretch.x * stretch.y * stretch.z < 0 ? -1 : 1;
    return area > 0 ? normal * (mirror / area) : Vec3d{};
}

/// The face nearest to a place among those of the leaves passed to improve().
class NearestSoFar {
  public:
    NearestSoFar(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch, double farthest)
        : map_(map), place_(place), stretch_(stretch), distance_sq_(farthest * farthest) {}

    /// Returns whether one of these faces is nearer than all previous ones.
    bool improve(const LeafFaces& faces) {
        const LeafDistances distances(map_, faces, place_, stretch_);
        const double before = distance_sq_;
        for (std::uint32_t lane = 0; lane < faces.last - faces.first; ++lane) {
            const double distance_sq = distances.distance_sq(lane);
            const std::uint32_t found = faces.first + lane;
            if (!(distance_sq <= distance_sq_) || (face_ && distance_sq == distance_sq_ && found > *face_))
                continue;
            distance_sq_ = distance_sq;
            face_ = found;
        }
        return distance_sq_ < before;
    }

    double distance_sq() const { return distance_sq_; }
    const std::optional<std::uint32_t>& face() const { return face_; }

  private:
    const ExactMapView& map_;
    const Vec3d &place_, &stretch_;
    double distance_sq_;
    std::optional<std::uint32_t> face_;
};

std::optional<std::uint32_t> nearest_face_from_afar(const ExactMapView& map, const Vec3d& place) {
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    const Vec3d from = brought_within_reach(place);
    const double centre_sq = dot(from, from), centre = std::sqrt(centre_sq);
    NearestSoFar nearest(map, from, kUnstretched, kUnbounded);
    float bound = std::numeric_limits<float>::max();
    walk_near_leaves(map, bound, BoxExcesses(from), [&](const LeafFaces& faces) {
        if (nearest.improve(faces))
            bound =
                static_cast<float>((nearest.distance_sq() - centre_sq) / (2 * centre)) + BoxExcesses::kSlack;
    });
    return nearest.face();
}

std::optional<std::uint32_t> nearest_face_from_nearby(const ExactMapView& map, const Vec3d& place,
                                                      const Vec3d& stretch, double farthest) {
    NearestSoFar nearest(map, place, stretch, farthest);
    float bound = bound_above(nearest.distance_sq());
    walk_near_leaves(map, bound, BoxDistances(place, stretch), [&](const LeafFaces& faces) {
        if (nearest.improve(faces)) bound = bound_above(nearest.distance_sq());
    });
    return nearest.face();
}

} // namespace

std::optional<std::uint32_t> nearest_face(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch,
                                          double farthest) noexcept {
    const bool unstretched = stretch == kUnstretched;
    if (unstretched ? !is_afar(place) : brought_within_reach(place, stretch) == place)
        return nearest_face_from_nearby(map, place, stretch, farthest);
    // No corner, snapped and rounded, is farther than 2 kLatticeExtent from the centre.
    if (farthest < length(stretched(place, stretch)) - 2 * static_cast<double>(kLatticeExtent))
        return std::nullopt;
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    const auto face = unstretched ? nearest_face_from_afar(map, place)
                                  : nearest_face_from_nearby(map, brought_within_reach(place, stretch),
                                                             stretch, kUnbounded);
    const bool is_within = face && distance_sq_to_face(map, *face, place, stretch) <= farthest * farthest;
    return is_within ? face : std::nullopt;
}

NearestPoint nearest_point_on_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                                   const Vec3d& stretch) noexcept {
    const Vec3d from = brought_within_reach(place, stretch);
    const auto [offset, distance, feature] = nearest_on_triangle(corners_around(map, face, from, stretch));
    const Vec3d point = from + Vec3d{offset.x / stretch.x, offset.y / stretch.y, offset.z / stretch.z};
    return {point, from == place ? distance : length(stretched(point - place, stretch)), face, feature};
}

double distance_sq_to_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                           const Vec3d& stretch) noexcept {
    const auto [a, b, c] = corners_around(map, face, place, stretch);
    return distance_sq_to_triangle(a, b, c);
}

Vec3f pseudonormal(const ExactMapView& map, const NearestPoint& nearest, const Vec3d& stretch,
                   double reach) noexcept {
    const Vec3d& point = nearest.point;
    const float bound = bound_above(reach * reach);
    Vec3d sum;
    walk_near_leaves(map, bound, BoxDistances(point, kUnstretched), [&](const LeafFaces& faces) {
        for (std::uint32_t face = faces.first; face < faces.last; ++face) {
            const Corners corners = corners_around(map, face, point, kUnstretched);
            if (nearest_on_triangle(corners).distance > reach) continue;
            sum += unit_normal(map, face, point, stretch) * double{spanned_angle(corners, reach)};
        }
    });
    constexpr double kCancelled = 1e-6;
    if (length(sum) < kCancelled) sum = unit_normal(map, nearest.face, point, stretch);
    const double l = length(sum);
    return l > 0 ? Vec3f(sum * (1 / l)) : Vec3f{0, 0, 1};
}

} // namespace echinus
