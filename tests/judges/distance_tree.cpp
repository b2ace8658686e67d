#include "judges/distance_tree.hpp"

#include <algorithm>
#include <cmath>

namespace echinus::test {

namespace {

double squared(const Vec3d& v) {
    return dot(v, v);
}

double segment_distance_sq(const Vec3d& point, const Vec3d& a, const Vec3d& b) {
    const Vec3d ab = b - a;
    const double length_sq = squared(ab);
    const double t = length_sq > 0 ? std::clamp(dot(point - a, ab) / length_sq, 0.0, 1.0) : 0;
    return squared(point - (a + ab * t));
}

/// The smallest distance to the edges and, where the foot of the perpendicular lies within the face, to its
/// plane.
double face_distance_sq(const Corners& face, const Vec3d& point) {
    const auto& [a, b, c] = face;
    const Vec3d normal = cross(b - a, c - a);
    const auto left_of = [&](const Vec3d& from, const Vec3d& to) {
        return dot(cross(to - from, point - from), normal) > 0;
    };
    if (left_of(a, b) && left_of(b, c) && left_of(c, a)) {
        const double along_normal = dot(point - a, normal);
        return along_normal * along_normal / squared(normal);
    }
    return std::min({segment_distance_sq(point, a, b), segment_distance_sq(point, b, c),
                     segment_distance_sq(point, c, a)});
}

bool has_three_corners(const Corners& face) {
    const auto& [a, b, c] = face;
    return a != b && b != c && c != a;
}

double coordinate(const Vec3d& v, std::size_t axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

std::size_t longest_axis(const Vec3d& size) {
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

} // namespace

double distance_to(const Corners& face, const Vec3d& point) {
    return std::sqrt(face_distance_sq(face, point));
}

DistanceTree::DistanceTree(std::vector<Corners> faces) : faces_(std::move(faces)) {
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
        if (has_three_corners(faces_[i])) order_.push_back(i);
    build(0, static_cast<std::uint32_t>(order_.size()));
}

DistanceTree::Box DistanceTree::box_of(std::span<const std::uint32_t> numbers) const {
    Box box{faces_[numbers.front()][0], faces_[numbers.front()][0]};
    for (const std::uint32_t number : numbers)
        for (const Vec3d& p : faces_[number]) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
        }
    return box;
}

/// Halves the faces at the median of their centres along the longest side of their box.
void DistanceTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({box_of(std::span(order_).subspan(begin, end - begin)), 0, begin, end - begin});
    if (end - begin <= kLeafSize) return;
    const std::size_t axis = longest_axis(nodes_[index].box.high - nodes_[index].box.low);
    const auto centre = [&](std::uint32_t number) {
        const auto& [a, b, c] = faces_[number];
        return coordinate(a + b + c, axis);
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::ranges::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, {},
                             centre);
    nodes_[index].count = 0;
    build(begin, middle);
    nodes_[index].second = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
}

double DistanceTree::distance_sq(const Box& box, const Vec3d& point) {
    const Vec3d outside{std::max({box.low.x - point.x, point.x - box.high.x, 0.0}),
                        std::max({box.low.y - point.y, point.y - box.high.y, 0.0}),
                        std::max({box.low.z - point.z, point.z - box.high.z, 0.0})};
    return squared(outside);
}

double DistanceTree::distance(const Vec3d& point, std::uint32_t hint) const {
    struct Waiting {
        std::uint32_t node;
        double distance_sq;
    };
    Waiting waiting[64]; // one per level, and each level halves the faces
    std::size_t count = 0;
    const Corners& first = faces_[has_three_corners(faces_[hint]) ? hint : order_.front()];
    double nearest_sq = face_distance_sq(first, point);
    waiting[count++] = {0, distance_sq(nodes_[0].box, point)};
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (next.distance_sq >= nearest_sq) continue;
        const Node& node = nodes_[next.node];
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            nearest_sq = std::min(nearest_sq, face_distance_sq(faces_[order_[i]], point));
        if (node.count > 0) continue;
        Waiting near{next.node + 1, distance_sq(nodes_[next.node + 1].box, point)};
        Waiting far{node.second, distance_sq(nodes_[node.second].box, point)};
        if (far.distance_sq < near.distance_sq) std::swap(near, far);
        waiting[count++] = far;
        waiting[count++] = near;
    }
    return std::sqrt(nearest_sq);
}

} // namespace echinus::test
