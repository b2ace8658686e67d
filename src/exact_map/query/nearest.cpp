#include "exact_map/query/nearest.hpp"

#include "exact_map/layout.hpp"
#include "exact_map/query/face_tree_walk.hpp"
#include "exact_map/query/triangle.hpp"

#include <cmath>
#include <limits>

namespace echinus {

namespace {

constexpr std::size_t kLanes = TreeNode::kWidth;

Vec3d stretched(const Vec3d& v, const Vec3d& stretch) {
    return {v.x * stretch.x, v.y * stretch.y, v.z * stretch.z};
}

/// Corners of a face, stretched, with the place as origin.
using Corners = TriangleCorners;

Corners corners_around(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                       const Vec3d& stretch) {
    const auto corners = face_corners(map, face);
    return {stretched(Vec3d(corners[0]) - place, stretch), stretched(Vec3d(corners[1]) - place, stretch),
            stretched(Vec3d(corners[2]) - place, stretch)};
}

/// Squared distance of a triangle from the origin, in a form that suits vector instructions: the face and its
/// three edges always, without a branch.
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
    // A face without area has no inside: all three are 0.
    const bool above = (above_ab > 0) & (above_bc > 0) & (above_ca > 0);
    return above ? to_plane : least;
}

/// Squared distances to the faces of a leaf. Each coordinate has an array of its own, for the compiler to
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
/// the place is moved towards each box by more than rounding can amount to.
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

/// A float a little above a double: by more than box distances are rounded. Infinity is excluded, since
/// missing children are at infinity.
float rounded_up(double value) {
    return static_cast<float>(std::min(value, 1e37)) * (1 + 1e-6F);
}

/// The normal of the stretched face, out of its front; 0 for one without area.
Vec3d unit_normal(const ExactMapView& map, std::uint32_t face, const Vec3d& place, const Vec3d& stretch) {
    const Corners corners = corners_around(map, face, place, stretch);
    const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = length(normal);
    const double mirror = stretch.x * stretch.y * stretch.z < 0 ? -1 : 1;
    return area > 0 ? normal * (mirror / area) : Vec3d{};
}

} // namespace

std::optional<NearestPoint> nearest_point(const ExactMapView& map, const Vec3d& place, const Vec3d& stretch,
                                          double farthest) noexcept {
    double nearest_sq = farthest * farthest;
    float bound = rounded_up(nearest_sq);
    std::optional<std::uint32_t> face;
    walk_near_leaves(map, bound, BoxDistances(place, stretch), [&](const LeafFaces& faces) {
        const LeafDistances distances(map, faces, place, stretch);
        for (std::uint32_t lane = 0; lane < faces.last - faces.first; ++lane) {
            const double distance_sq = distances.distance_sq(lane);
            const std::uint32_t found = faces.first + lane;
            if (!(distance_sq <= nearest_sq) || (face && distance_sq == nearest_sq && found > *face))
                continue;
            nearest_sq = distance_sq;
            bound = rounded_up(nearest_sq);
            face = found;
        }
    });
    if (!face) return std::nullopt;
    return nearest_point_on_face(map, *face, place, stretch);
}

NearestPoint nearest_point_on_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                                   const Vec3d& stretch) noexcept {
    const auto [offset, distance, feature] = nearest_on_triangle(corners_around(map, face, place, stretch));
    return {place + Vec3d{offset.x / stretch.x, offset.y / stretch.y, offset.z / stretch.z}, distance, face,
            feature};
}

double distance_sq_to_face(const ExactMapView& map, std::uint32_t face, const Vec3d& place,
                           const Vec3d& stretch) noexcept {
    const auto [a, b, c] = corners_around(map, face, place, stretch);
    return distance_sq_to_triangle(a, b, c);
}

Vec3f pseudonormal(const ExactMapView& map, const NearestPoint& nearest, const Vec3d& stretch,
                   double reach) noexcept {
    constexpr Vec3d kUnstretched{1, 1, 1};
    const Vec3d& point = nearest.point;
    const float bound = rounded_up(reach * reach);
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
