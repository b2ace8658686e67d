#include "judges/judge_trees.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

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

namespace {

constexpr std::uint32_t kLeafSize = 8;

/// van Oosterom and Strackee, "The Solid Angle of a Plane Triangle" (1983).
double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 *
           std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

bool is_within(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z && p.z <= high.z;
}

double coordinate(const Vec3d& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

} // namespace

SolidAngleTree::SolidAngleTree(const TriangleMesh& mesh) {
    const TriangleMesh welded = weld(mesh); // more edges cancel, which shortens the borders
    for (const Vec3f& vertex : welded.vertices) vertices_.emplace_back(vertex);
    faces_ = welded.faces;
    order_.resize(faces_.size());
    std::iota(order_.begin(), order_.end(), 0U);
    build(0, static_cast<std::uint32_t>(order_.size()));
}

void SolidAngleTree::find_box(Node& node) const {
    node.low = node.high = vertices_[faces_[order_[node.first]][0]];
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count))
        for (const std::uint32_t vertex : faces_[face]) {
            const Vec3d& p = vertices_[vertex];
            node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y), std::min(node.low.z, p.z)};
            node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y), std::max(node.high.z, p.z)};
        }
}

/// The edges along which more faces run in one direction than in the other.
void SolidAngleTree::find_border(Node& node) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::int32_t> balance;
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count))
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = faces_[face][k], to = faces_[face][(k + 1) % 3];
            balance[std::minmax(from, to)] += from < to ? 1 : -1;
        }
    node.first_edge = static_cast<std::uint32_t>(edges_.size());
    for (const auto& [edge, multiplicity] : balance)
        if (multiplicity != 0) edges_.push_back({edge.first, edge.second, multiplicity});
    node.edge_count = static_cast<std::uint32_t>(edges_.size()) - node.first_edge;
    if (node.edge_count > 0) node.apex = edges_[node.first_edge].from;
}

/// Sorts the node's faces into two halves along the longest side of its box.
std::uint32_t SolidAngleTree::split(const Node& node) {
    const Vec3d size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = order_.begin() + node.first;
    const std::uint32_t half = node.count / 2;
    std::ranges::nth_element(begin, begin + half, begin + node.count, {}, [&](std::uint32_t face) {
        const auto& [a, b, c] = faces_[face];
        return coordinate(vertices_[a] + vertices_[b] + vertices_[c], axis);
    });
    return node.first + half;
}

void SolidAngleTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Node node;
    node.first = begin;
    node.count = end - begin;
    find_box(node);
    find_border(node);
    if (node.count > kLeafSize) {
        const std::uint32_t middle = split(node);
        build(begin, middle);
        node.second = static_cast<std::uint32_t>(nodes_.size());
        build(middle, end);
    }
    nodes_[index] = node;
}

double SolidAngleTree::solid_angle(std::uint32_t index, const Vec3d& point) const {
    const Node& node = nodes_[index];
    double sum = 0;
    if (node.edge_count < node.count && !is_within(point, node.low, node.high)) {
        const Vec3d apex = vertices_[node.apex] - point;
        for (const Edge& edge : std::span(edges_).subspan(node.first_edge, node.edge_count))
            sum += edge.multiplicity *
                   triangle_solid_angle(apex, vertices_[edge.from] - point, vertices_[edge.to] - point);
        return sum;
    }
    if (node.second != 0) return solid_angle(index + 1, point) + solid_angle(node.second, point);
    for (const std::uint32_t face : std::span(order_).subspan(node.first, node.count)) {
        const auto& [a, b, c] = faces_[face];
        sum += triangle_solid_angle(vertices_[a] - point, vertices_[b] - point, vertices_[c] - point);
    }
    return sum;
}

double SolidAngleTree::winding_number(const Vec3d& point) const {
    return solid_angle(0, point) / (4 * std::numbers::pi);
}

} // namespace echinus::test
